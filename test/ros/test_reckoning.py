# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where the follower takes its target to be."""

import numpy as np
import pytest

from het_ros.ros.reckoning import Reckoning

DT = 0.05


def reckoned(places, told=(0.0, 0.0)):
    """(n, 2) m: after each of the places seen (n, 2), m."""
    reckoning, found = Reckoning(), []
    for frame, (x, z) in enumerate(places):
        reckoning.told(*told, frame * DT)
        reckoning.seen(x, z, frame * DT)
        found.append(reckoning.predicted(frame * DT))
    return np.array(found)


def walk(frames=100):
    """It crosses at 0.8 m/s, 4 m away."""
    x = -2 + 0.8 * DT * np.arange(frames)
    return np.stack([x, np.full(frames, 4.0)], axis=1)


def test_an_even_walk_is_not_late():
    np.testing.assert_allclose(reckoned(walk()), walk(), atol=1e-9)


def test_it_shakes_less_than_single_places():
    noise = np.random.default_rng(0).normal(0, 0.05, walk().shape)
    found = reckoned(walk() + noise)
    raw = np.diff(walk() + noise, axis=0).std()
    assert np.diff(found[10:], axis=0).std() < raw / 2


def test_the_robots_own_motion_is_taken_out():
    """What stands still comes nearer by what the robot drives."""
    away = 4.0 - 0.4 * DT * np.arange(60)
    places = np.stack([np.zeros(60), away], axis=1)
    np.testing.assert_allclose(reckoned(places, told=(0.4, 0.0)), places, atol=1e-9)


def test_a_hidden_target_goes_on():
    reckoning = Reckoning()
    for frame, (x, z) in enumerate(walk(40)):
        reckoning.seen(x, z, frame * DT)
    x, z = reckoning.predicted(39 * DT + 1.0)
    assert (x, z) == pytest.approx((walk(40)[-1, 0] + 0.8, 4.0))
