# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.inertia import Inertia

SIDE, DT = 40.0, 0.1
NOTHING = np.zeros(2)


class Footage:
    """Images of a made street that a camera looks at, turned to ``way`` px from its start."""

    def __init__(self):
        rng = np.random.default_rng(2)
        self.street = np.kron(rng.integers(0, 256, (60, 160), np.uint8), np.ones((8, 8), np.uint8))

    def at(self, way):
        x, y = (640 - int(way[0]), 160 - int(way[1]))
        return self.street[y : y + 160, x : x + 240]


def follow(camera_ways, target_ways):
    """Run through places of scene and target, px (n, 2) each; the last shift and all changes."""
    footage = Footage()
    inertia = Inertia(footage.at(camera_ways[0]), np.array(target_ways[0], float))
    shifts, changes = [], []
    for camera, target in zip(camera_ways[1:], target_ways[1:], strict=True):
        shifts.append(inertia.shift(footage.at(camera), DT))
        changes.append(inertia.observe(np.array(target, float), SIDE, DT))
    return inertia, np.array(shifts), np.array(changes)


@pytest.fixture
def shake():
    return np.random.default_rng(4).integers(-20, 21, (30, 2))


def test_a_target_that_shakes_with_the_scene_lives_in_the_scene(shake):
    walk = np.arange(30)[:, None] * [3, 0]
    inertia, shifts, changes = follow(shake, shake + walk)
    assert np.abs(shifts[-1] - (shake[-1] - shake[-2])).max() < 1
    assert (changes != 0).any(axis=1).sum() == 1
    assert np.abs(inertia.carried).max() > 0


def test_a_target_that_the_camera_is_turned_after_lives_in_the_image():
    turn = np.cumsum(np.random.default_rng(4).integers(-14, 5, (30, 2)), axis=0)
    still = np.full((30, 2), 100)
    inertia, shifts, changes = follow(turn, still)
    assert (shifts == 0).all()
    assert (changes == 0).all()
    assert (inertia.carried == NOTHING).all()


def test_with_a_camera_that_stands_still_nothing_changes():
    walk = np.arange(30)[:, None] * [3, 1]
    _, shifts, changes = follow(np.zeros((30, 2)), walk)
    assert (shifts == 0).all()
    assert (changes == 0).all()


def test_the_velocity_changes_by_that_of_the_camera_and_back(shake):
    """Into the scene and out of it again: what is taken off is given back, as it is by then."""
    camera = np.concatenate([shake, shake[-1] + np.cumsum(shake, axis=0) // 2])
    target = np.concatenate([shake, np.repeat(shake[-1:], 30, axis=0)])
    inertia, _, changes = follow(camera, target)
    turns = np.flatnonzero((changes != 0).any(axis=1))
    assert len(turns) == 2
    assert turns[0] < 29 <= turns[1]
    assert (inertia.carried == NOTHING).all()


def test_what_was_hidden_in_between_is_no_way(shake):
    footage = Footage()
    inertia = Inertia(footage.at((0, 0)), np.zeros(2))
    for _ in range(5):
        inertia.shift(footage.at((0, 0)), DT)
        inertia.observe(NOTHING, SIDE, DT)
    inertia.forget()
    inertia.shift(footage.at((30, 0)), DT)
    assert (inertia.observe(np.array([300.0, 0.0]), SIDE, DT) == NOTHING).all()
    assert (inertia.carried == NOTHING).all()
