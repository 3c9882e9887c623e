# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The part of a follower's command that is the target's own motion."""

import pytest

from het_ros.ros.feed_forward import FeedForward

DT = 0.05


def after(relative, place, twist):
    ahead = FeedForward(0.3)
    for step in range(100):
        ahead.told(*twist)
        ahead.on_place(*place)
        ahead.on_velocity(*relative, step * DT)
    return ahead, 99 * DT


@pytest.mark.parametrize(
    ("relative", "place", "twist", "expected"),
    [
        ((0.0, 0.5), (0.0, 4.0), (0.0, 0.0), (0.5, 0.0)),  # it walks away from a standing robot
        ((0.0, 0.0), (0.0, 4.0), (0.5, 0.0), (0.5, 0.0)),  # and from one that keeps up
        ((0.0, -0.5), (0.0, 4.0), (0.5, 0.0), (0.0, 0.0)),  # it stands, the robot comes
        ((1.0, 0.0), (0.0, 4.0), (0.0, 0.25), (0.0, 0.0)),  # it stands, the robot turns left
        ((1.0, 0.0), (0.0, 4.0), (0.0, 0.0), (0.0, -0.25)),  # it goes right: turn right
    ],
)
def test_whose_motion_it_is(relative, place, twist, expected):
    ahead, now = after(relative, place, twist)
    assert ahead.rates(*place, now) == pytest.approx(expected, abs=0.01)


def test_an_old_velocity_is_none():
    ahead, now = after((0.0, 0.5), (0.0, 4.0), (0.0, 0.0))
    assert ahead.known(now) and not ahead.known(now + 0.4)
    assert ahead.rates(0.0, 4.0, now + 0.4) == (0.0, 0.0)
