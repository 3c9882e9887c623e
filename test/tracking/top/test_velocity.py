# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The filter of the published velocity, on motions with known velocity."""

import itertools

import numpy as np
import pytest

from het_ros.tracking.top.velocity import VelocityFilter

SIDE, DT = 40.0, 1 / 30


def followed(places, dt=DT):
    velocities = VelocityFilter(places[0], SIDE)
    motions = [velocities.motion]
    for place in places[1:]:
        velocities.predict(dt, SIDE)
        velocities.correct(place)
        motions.append(velocities.motion)
    return motions


def even(frames, speed, noise, dt=DT, seed=0):
    way = np.arange(frames)[:, None] * dt * np.array([speed, -speed / 2])
    return way + np.random.default_rng(seed).normal(0, noise * SIDE, way.shape)


def total(motions):
    return np.array([motion.total for motion in motions])


@pytest.mark.parametrize("dt", [1 / 60, 1 / 30, 1 / 10])
def test_an_even_motion_is_found(dt):
    found = total(followed(even(round(2 / dt), 80.0, 0.0, dt), dt))[-1]
    np.testing.assert_allclose(found, [80, -40], rtol=0.15)


def test_what_stands_still_has_no_velocity():
    assert np.abs(total(followed(even(60, 0.0, 0.0)))).max() == 0


def test_it_shakes_less_than_differences():
    places = even(200, 60.0, 0.03)
    differences = np.diff(places, axis=0) / DT
    change = np.diff(total(followed(places))[20:], axis=0).std()
    assert change < np.diff(differences, axis=0).std() / 4


def test_a_turn_is_followed_within_a_third_of_a_second():
    there = np.concatenate([np.arange(60) * 3.0, 177 - np.arange(1, 31) * 3.0])
    found = total(followed(np.stack([there, 0 * there], axis=1)))
    assert found[59, 0] > 60 and found[69, 0] < -45


def test_covariance_holds_on_a_random_walk():
    rng = np.random.default_rng(1)
    velocity = np.cumsum(rng.normal(0, 1.5 * SIDE * DT**0.5, (2000, 2)), axis=0)
    places = np.cumsum(velocity * DT, axis=0) + rng.normal(0, 0.05 * SIDE, (2000, 2))
    motions = followed(places)[50:]
    errors = total(motions) - velocity[50:]
    spread = np.array([motion.covariance[0, 0] for motion in motions])
    assert ((errors**2).sum(axis=1) < 5.99 * spread).mean() > 0.9


def test_what_shakes_more_is_known_less():
    """With the covariance of the filter alone it would be the same for all but the wildest."""
    spreads = [
        np.mean([m.covariance[0, 0] for m in followed(even(120, 60.0, noise))[60:]])
        for noise in (0.01, 0.05, 0.1, 0.2)
    ]
    assert all(more > 1.5 * less for less, more in itertools.pairwise(spreads))


def test_a_hidden_target_slows_and_is_known_less_and_less():
    velocities = VelocityFilter(np.zeros(2), SIDE)
    for place in even(60, 80.0, 0.0)[1:]:
        velocities.predict(DT, SIDE)
        velocities.correct(place)
    speeds, spreads = [velocities.motion.total[0]], [velocities.motion.covariance[0, 0]]
    for _ in range(20):
        velocities.predict(DT, SIDE)
        velocities.coast()
        speeds.append(velocities.motion.total[0])
        spreads.append(velocities.motion.covariance[0, 0])
    assert (np.diff(speeds) < 0).all() and speeds[-1] > 0
    assert (np.diff(spreads[1:]) > 0).all()


def test_a_way_is_the_sum_of_its_parts():
    motion = followed(even(40, 80.0, 0.02))[-1]
    both = motion.way(0.1) + motion.later(0.1).way(0.2)
    np.testing.assert_allclose(motion.way(0.3), both)
    assert np.trace(motion.way_covariance(0.5)) > np.trace(motion.way_covariance(0.1)) > 0
