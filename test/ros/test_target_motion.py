# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Place and velocity in metres, of places with known velocity."""

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped

from het_ros.ros.messages import header_of
from het_ros.ros.target_motion import TargetMotion

RATE = 15


def walked(frames, track=1, motion=None, start=1):
    """0.6 m/s to the right and 0.3 m/s away."""
    motion = motion or TargetMotion()
    for frame in range(frames):
        place = PoseStamped(header=header_of(round((start + frame / RATE) * 1e9), "optical"))
        position = place.pose.position
        position.x, position.y, position.z = 0.6 * frame / RATE, 0.1, 4 + 0.3 * frame / RATE
        motion.take(place, track)
    return motion, place


def test_velocity_and_place_of_an_even_walk():
    motion, place = walked(45)
    twist, pose = motion.velocity(place.header), motion.pose(place.header)
    linear, position = twist.twist.twist.linear, pose.pose.pose.position
    found = [linear.x, linear.y, linear.z]
    np.testing.assert_allclose(found, [0.6, 0, 0.3], atol=0.1)
    assert twist.header.frame_id == pose.header.frame_id == "optical"
    assert position.z == pytest.approx(place.pose.position.z, abs=0.05)
    for covariance in (twist.twist.covariance, pose.pose.covariance):
        assert (np.linalg.eigvalsh(covariance.reshape(6, 6)[:3, :3]) > 0).all()


def test_a_place_ahead_keeps_the_stamp():
    motion, place = walked(45)
    later = motion.ahead(place, 0.5)
    assert later.header == place.header
    assert later.pose.position.x - place.pose.position.x == pytest.approx(0.3, abs=0.06)
    assert motion.ahead(place, 0.0) is place


def test_another_track_is_another_target():
    motion, _ = walked(45)
    _, place = walked(1, track=2, motion=motion, start=4)
    linear = motion.velocity(place.header).twist.twist.linear
    assert (linear.x, linear.z) == (0, 0)


def test_nothing_is_said_before_any_place():
    motion = TargetMotion()
    assert motion.pose(header_of(1)) is None and motion.velocity(header_of(1)) is None
