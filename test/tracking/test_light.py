# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import numpy as np
import pytest

from het_ros import HierarchicalEnsembleTracker, State, TrackerConfig
from het_ros.tracking.light import Change, Light, levels_of, light_jump
from het_ros.tracking.window import cut_window

WARMER = Change(np.array([0.7, 1.0, 1.1]), np.array([-5.0, 0.0, 20.0]))  # white balance
DARKER = Change(np.full(3, 0.6), np.full(3, 4.0))  # exposure
FLATTER = Change(np.full(3, 0.7), np.full(3, 60.0))  # haze, backlight


def lit(pixels, change):
    """The pixels after that change of light, as a camera would give them."""
    return np.rint(change.apply(pixels.astype(float))).clip(0, 255).astype(np.uint8)


@pytest.fixture
def window(sequence):
    """Place of a window about somebody in real footage: ``window(k)`` is of frame k."""
    footage = sequence("Crossing")
    box = footage.boxes[0]

    def cut(index, x=0.0):
        return cut_window(footage.image(index), box.x - 30 + x, box.y - 30, 90, 110).pixels

    return cut


@pytest.mark.parametrize("change", [WARMER, DARKER, FLATTER], ids=["warmer", "darker", "flatter"])
def test_a_jump_is_taken_back(window, change):
    light = Light()
    light.observe(window(0))
    now = lit(window(1), change)
    light.observe(now)
    assert np.abs(light.undo(now).astype(int) - window(1)).mean() < 6
    assert np.abs(now.astype(int) - window(1)).mean() > 15


def test_a_jump_back_leaves_no_trace(window):
    light = Light()
    for pixels in (window(0), lit(window(1), DARKER), window(2)):
        light.observe(pixels)
    assert light.undo(pixels) is pixels


def test_a_gray_jump_is_taken_back(window):
    gray = window(0)[..., 1]
    light = Light()
    light.observe(gray)
    dark = (0.6 * gray).astype(np.uint8)
    light.observe(dark)
    assert light.undo(dark).shape == gray.shape
    assert np.abs(light.undo(dark).astype(int) - gray).mean() < 4


def test_several_jumps_add_up(window):
    light = Light()
    now = window(0)
    light.observe(now)
    for change in (WARMER, FLATTER):
        now = lit(now, change)
        light.observe(now)
    assert np.abs(light.undo(now).astype(int) - window(0)).mean() < 6


def covered(pixels):
    """The window with something dark in front of 45 % of it."""
    pixels = pixels.copy()
    pixels[:, : int(0.45 * pixels.shape[1])] = 20
    return pixels


@pytest.mark.parametrize(
    "change",
    [
        lambda window: window(1),
        lambda window: window(60),  # two seconds later
        lambda window: window(1, x=25.0),  # the camera turned
        lambda window: covered(window(1)),
        lambda window: np.flip(window(0), axis=1),
        lambda window: np.random.default_rng(0).integers(0, 256, window(0).shape, np.uint8),
    ],
    ids=["next", "later", "turned", "covered", "flipped", "noise"],
)
def test_what_moves_is_no_jump(window, change):
    assert light_jump(levels_of(window(0)), levels_of(change(window))) is None


@pytest.mark.parametrize("value", [0, 128, 255])
def test_flat_windows_are_no_trouble(value):
    light = Light()
    for level in (value, 255 - value, value):
        pixels = np.full((60, 50, 3), level, np.uint8)
        light.observe(pixels)
        assert light.undo(pixels).shape == pixels.shape


def test_after_another_place_nothing_is_compared(window):
    light = Light()
    light.observe(window(0))
    light.forget()
    dark = lit(window(1), DARKER)
    light.observe(dark)
    assert light.undo(dark) is dark


@pytest.mark.parametrize("change", [WARMER, DARKER, FLATTER], ids=["warmer", "darker", "flatter"])
def test_a_target_is_kept_in_a_light_that_jumps(sequence, change):
    footage = sequence("Couple")
    overlaps = {}
    for taken_back in (True, False):
        config = replace(TrackerConfig(), light_jumps=taken_back)
        tracker = HierarchicalEnsembleTracker(config)
        tracker.init(footage.image(0), footage.boxes[0])
        for index in range(1, 60):
            image = footage.image(index)
            estimate = tracker.update(lit(image, change) if index >= 30 else image, 1 / 30)
            if index >= 30:
                overlap = estimate.box.iou(footage.boxes[index])
                seen = estimate.state is State.TRACKING
                overlaps.setdefault(taken_back, []).append(overlap if seen else 0.0)
    assert np.mean(np.array(overlaps[True]) > 0.4) > 0.9
    assert np.mean(overlaps[True]) >= np.mean(overlaps[False]) - 0.02
