# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The target's place and velocity in metres, filtered, in the camera's optical frame (REP-103).

The frame moves with the camera (REP-105: it is no fixed frame), so the velocity is that relative
to the camera: of a robot that drives towards a standing target it is towards the robot.
"""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TwistWithCovarianceStamped
from std_msgs.msg import Header

from het_ros.ros.messages import header_of, stamp_ns, twist_from_estimate
from het_ros.ros.stamps import SECOND
from het_ros.tracking.estimate import Estimate
from het_ros.tracking.top.velocity import VelocityConfig, VelocityFilter

LONGEST = 1.0  # s between two places, after which a velocity says nothing
# Of people and the cameras of robots, in metres: a place is known to some centimetres.
METRES = VelocityConfig(
    centre=0.05,
    steady_change=0.8,
    brief_change=2.0,
    steady_time=4.0,
    brief_time=0.1,
    first_speed=1.5,
    coast_time=4.0,
    coast_change=2.0,
)


class TargetMotion:
    """Filters the places of one track after the other."""

    def __init__(self) -> None:
        self._filter: VelocityFilter | None = None
        self._track, self._stamp = -1, 0

    def take(self, place: PoseStamped, track: int) -> None:
        """Take in a track's measured place; an older one than the last is left out."""
        stamp, position = stamp_ns(place.header), place.pose.position
        where = np.array([position.x, position.y, position.z])
        passed = (stamp - self._stamp) / SECOND
        if self._filter is None or track != self._track or not 0 <= passed <= LONGEST:
            self._filter = VelocityFilter(where, 1.0, METRES)
        elif passed > 0:
            self._filter.predict(passed, 1.0)
            self._filter.correct(where)
        self._track, self._stamp = track, stamp

    def pose(self, header: Header, ahead: float = 0.0) -> PoseWithCovarianceStamped | None:
        """The filtered place with its covariance, m^2, ``ahead`` s later; None before any."""
        if self._filter is None:
            return None
        motion = self._filter.motion
        message = PoseWithCovarianceStamped(header=header)
        position, place = message.pose.pose.position, self._filter.centre + motion.way(ahead)
        position.x, position.y, position.z = map(float, place)
        unsure = self._filter.centre_variance * np.eye(3) + motion.way_covariance(ahead)
        message.pose.covariance = _spatial(unsure)
        return message

    def velocity(self, header: Header) -> TwistWithCovarianceStamped | None:
        """The velocity with its covariance, m^2/s^2; None before any place."""
        if self._filter is None:
            return None
        motion = self._filter.motion
        message = TwistWithCovarianceStamped(header=header)
        linear = message.twist.twist.linear
        linear.x, linear.y, linear.z = map(float, motion.steady + motion.brief)
        message.twist.covariance = _spatial(motion.covariance)
        return message

    def ahead(self, place: PoseStamped, seconds: float) -> PoseStamped:
        """A place just taken in, ``seconds`` later, stamped as its image."""
        if self._filter is None or seconds <= 0:
            return place
        way = self._filter.motion.way(seconds)
        message = PoseStamped(header=header_of(stamp_ns(place.header), place.header.frame_id))
        message.pose.orientation = place.pose.orientation
        position, now = message.pose.position, place.pose.position
        position.x, position.y, position.z = map(float, way + np.array([now.x, now.y, now.z]))
        return message


def twist_in_scene(estimate: Estimate, header: Header) -> TwistWithCovarianceStamped | None:
    """The velocity against what stands still, px/s; None where it is not known."""
    if estimate.velocity_in_scene is None:
        return None
    message = twist_from_estimate(estimate, header)
    x, y = estimate.velocity_in_scene
    message.twist.twist.linear.x, message.twist.twist.linear.y = float(x), float(y)
    return message


def _spatial(block: np.ndarray) -> list[float]:
    """A (3, 3) covariance as the first rows and columns of ROS's row-major 6 x 6."""
    whole = np.zeros((6, 6))
    whole[:3, :3] = block
    return [float(value) for value in whole.ravel()]
