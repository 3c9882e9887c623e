# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Boxes and estimates to messages and back; pure functions, no node.

Pixels stay pixels: REP-103 wants SI units, but a tracker on one camera has none to give. The
topics' documentation names the units, and every output carries the header of its image.
"""

from __future__ import annotations

import math

from builtin_interfaces.msg import Time
from geometry_msgs.msg import (
    Point32,
    PolygonStamped,
    PoseWithCovarianceStamped,
    TwistWithCovarianceStamped,
)
from sensor_msgs.msg import RegionOfInterest
from std_msgs.msg import Header

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Estimate

SMALLEST_AREA = 16.0  # px^2: under this there is nothing to learn from
SMALLEST_SIDE = 1.0  # px: a narrower box is a slip, and costs as much as a long one


class BoxError(ValueError):
    """A box that cannot start a track; the text says why."""


def box_from_polygon(message: PolygonStamped) -> Box:
    """The bounds of a polygon's corners, px.

    Raises:
        BoxError: fewer than 2 points, a NaN or infinite corner, an area under 16 px^2 or a side
            under 1 px.
    """
    points = message.polygon.points
    if len(points) < 2:
        raise BoxError(f"a box needs two corners or more, the polygon has {len(points)} points")
    xs = [point.x for point in points]
    ys = [point.y for point in points]
    if not all(math.isfinite(value) for value in (*xs, *ys)):
        raise BoxError("the polygon has a NaN or infinite corner")
    return _checked(min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys))


def box_from_roi(message: RegionOfInterest) -> Box:
    """A region of interest as a box, px.

    Raises:
        BoxError: an area under 16 px^2 (a region of 0 x 0 px means "nothing" here).
    """
    return _checked(message.x_offset, message.y_offset, message.width, message.height)


def _checked(x: float, y: float, w: float, h: float) -> Box:
    if w * h < SMALLEST_AREA or min(w, h) < SMALLEST_SIDE:
        raise BoxError(
            f"the box is {w:g} x {h:g} px; it takes {SMALLEST_AREA:g} px^2 or more, and sides of "
            f"{SMALLEST_SIDE:g} px or more"
        )
    return Box(float(x), float(y), float(w), float(h))


def polygon_from_box(box: Box, header: Header) -> PolygonStamped:
    """The four corners, clockwise from the top left, px."""
    message = PolygonStamped(header=header)
    # float(): a message stores any other kind of number as 0 without a word.
    left, top, right, bottom = map(float, (box.x, box.y, box.x + box.w, box.y + box.h))
    corners = ((left, top), (right, top), (right, bottom), (left, bottom))
    message.polygon.points = [Point32(x=x, y=y, z=0.0) for x, y in corners]
    return message


def roi_from_box(box: Box, width: int, height: int) -> RegionOfInterest:
    """The part of a box inside an image of that size, rounded outwards to whole pixels.

    Raises:
        BoxError: no part of the box lies in the image.
    """
    left, top = max(math.floor(box.x), 0), max(math.floor(box.y), 0)
    right = min(math.ceil(box.x + box.w), width)
    bottom = min(math.ceil(box.y + box.h), height)
    if right <= left or bottom <= top:
        raise BoxError(f"{box} lies wholly outside an image of {width} x {height} px")
    return RegionOfInterest(
        x_offset=left, y_offset=top, width=right - left, height=bottom - top, do_rectify=False
    )


def pose_from_estimate(estimate: Estimate, header: Header) -> PoseWithCovarianceStamped:
    """The box's centre (px) with its covariance (px^2) in rows and columns x, y."""
    message = PoseWithCovarianceStamped(header=header)
    position = message.pose.pose.position
    position.x, position.y = map(float, estimate.box.centre)
    message.pose.covariance = _planar(estimate.covariance[:2, :2])
    return message


def twist_from_estimate(estimate: Estimate, header: Header) -> TwistWithCovarianceStamped:
    """The centre's velocity (px/s) with its covariance (px^2/s^2) in rows and columns x, y."""
    message = TwistWithCovarianceStamped(header=header)
    message.twist.twist.linear.x, message.twist.twist.linear.y = map(float, estimate.velocity)
    message.twist.covariance = _planar(estimate.covariance[2:, 2:])
    return message


def _planar(block) -> list[float]:
    """A (2, 2) covariance as the first rows and columns of ROS's row-major 6 x 6."""
    covariance = [0.0] * 36
    covariance[0], covariance[1] = float(block[0, 0]), float(block[0, 1])
    covariance[6], covariance[7] = float(block[1, 0]), float(block[1, 1])
    return covariance


def stamp_ns(header: Header) -> int:
    """The header's stamp in ns."""
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)


def header_of(stamp: int, frame_id: str = "") -> Header:
    """A header with that stamp, ns: :func:`stamp_ns` the other way round."""
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    return Header(stamp=Time(sec=seconds, nanosec=nanoseconds), frame_id=frame_id)
