# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest
from geometry_msgs.msg import Point32, PolygonStamped
from sensor_msgs.msg import RegionOfInterest

from het_ros import Box, Estimate, State
from het_ros.ros.messages import (
    BoxError,
    box_from_polygon,
    box_from_roi,
    header_of,
    polygon_from_box,
    pose_from_estimate,
    roi_from_box,
    stamp_ns,
    twist_from_estimate,
)

from .streams import header_at

HEADER = header_at(12.25, "optical")


def polygon(*corners) -> PolygonStamped:
    message = PolygonStamped()
    message.polygon.points = [Point32(x=float(x), y=float(y)) for x, y in corners]
    return message


@pytest.mark.parametrize(
    "corners, box",
    [
        ([(10, 20), (30, 60)], (10, 20, 20, 40)),  # two opposite corners, any order
        ([(30, 60), (10, 20)], (10, 20, 20, 40)),
        ([(10, 60), (30, 20)], (10, 20, 20, 40)),
        ([(10, 20), (30, 20), (30, 60), (10, 60)], (10, 20, 20, 40)),
        ([(20, 20), (30, 40), (20, 60), (10, 40)], (10, 20, 20, 40)),  # a rotated box: its bounds
        ([(-5.5, -2.5), (4.5, 7.5)], (-5.5, -2.5, 10, 10)),
        ([(0, 0), (4, 4)], (0, 0, 4, 4)),  # 16 px^2 is just enough
    ],
)
def test_box_is_the_bounds_of_a_polygon(corners, box):
    assert box_from_polygon(polygon(*corners)).as_tuple() == box


@pytest.mark.parametrize(
    "corners, says",
    [
        ([], "0 points"),
        ([(1, 1)], "1 points"),
        ([(math.nan, 1), (50, 50)], "NaN or infinite"),
        ([(1, 1), (50, math.inf)], "NaN or infinite"),
        ([(1, 1), (50, 50), (20, -math.inf)], "NaN or infinite"),
        ([(1, 1), (4.9, 5)], "16 px"),
        ([(1, 1), (1, 500)], "16 px"),
        ([(1, 1), (1.5, 500)], "sides of 1 px"),
        ([(0, 0), (1e-5, 3.4e38)], "sides of 1 px"),  # it took all memory
        ([(7, 7)] * 4, "16 px"),
    ],
)
def test_polygons_that_are_refused(corners, says):
    with pytest.raises(BoxError, match=says):
        box_from_polygon(polygon(*corners))


def test_box_of_a_region():
    region = RegionOfInterest(x_offset=3, y_offset=4, width=8, height=9)
    assert box_from_roi(region).as_tuple() == (3, 4, 8, 9)
    with pytest.raises(BoxError, match="16 px"):
        box_from_roi(RegionOfInterest())


def test_a_box_survives_the_way_there_and_back():
    box = Box(10.5, -4.25, 20, 41)
    message = polygon_from_box(box, HEADER)
    assert box_from_polygon(message) == box
    assert message.header == HEADER
    corners = [(p.x, p.y) for p in message.polygon.points]
    assert corners == [(10.5, -4.25), (30.5, -4.25), (30.5, 36.75), (10.5, 36.75)]


@pytest.mark.parametrize(
    "box, region",
    [
        (Box(10, 20, 30, 40), (10, 20, 30, 40)),
        (Box(10.4, 20.6, 30, 40), (10, 20, 31, 41)),
        (Box(-10, -20, 30, 40), (0, 0, 20, 20)),
        (Box(630, 470, 30, 40), (630, 470, 10, 10)),
    ],
)
def test_region_is_clipped_to_the_image(box, region):
    message = roi_from_box(box, 640, 480)
    assert (message.x_offset, message.y_offset, message.width, message.height) == region


def test_there_is_no_region_outside_the_image():
    with pytest.raises(BoxError, match="outside"):
        roi_from_box(Box(700, 10, 20, 20), 640, 480)


def test_covariances_stand_where_ros_wants_them():
    covariance = np.arange(16, dtype=float).reshape(4, 4)
    estimate = Estimate(Box(10, 20, 30, 40), (3.0, -4.0), covariance, 0.5, State.TRACKING)
    pose = pose_from_estimate(estimate, HEADER)
    twist = twist_from_estimate(estimate, HEADER)

    assert pose.header == twist.header == HEADER
    assert (pose.pose.pose.position.x, pose.pose.pose.position.y) == (25, 40)
    assert pose.pose.pose.orientation.w == 1
    assert (twist.twist.twist.linear.x, twist.twist.twist.linear.y) == (3, -4)
    for message, block in ((pose.pose, covariance[:2, :2]), (twist.twist, covariance[2:, 2:])):
        matrix = message.covariance.reshape(6, 6)
        np.testing.assert_array_equal(matrix[:2, :2], block)
        assert matrix[2:].any() == matrix[:, 2:].any() == False  # noqa: E712


def test_stamp_in_nanoseconds():
    assert (HEADER.stamp.sec, HEADER.stamp.nanosec) == (12, 250_000_000)
    assert stamp_ns(HEADER) == 12_250_000_000
    assert stamp_ns(header_of(-1)) == -1
