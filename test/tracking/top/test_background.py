# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import tracemalloc

import cv2
import numpy as np
import pytest

from het_ros import Box, TrackerConfig
from het_ros.scene import SceneConfig
from het_ros.scene.honesty import followed, honesty
from het_ros.tracking.top.background import Background, BackgroundConfig, best_fit

W, H = 30, 60
POST = Box(200.0, 60.0, W, H)
DT = 0.1


def texture(seed, height, width, coarse):
    rng = np.random.default_rng(seed)
    small = rng.integers(0, 256, (height // coarse, width // coarse, 3), np.uint8)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC)


STREET = texture(1, 240, 480, 12)
FIGURE = texture(2, H, W, 6)


def view(x, camera=(0, 0), figure=True):
    """The street with the figure at ``x``, and its box, as a camera sees it that has moved."""
    image = STREET.copy()
    if figure:
        image[60 : 60 + H, x : x + W] = FIGURE
    left, top = camera
    moved = cv2.warpAffine(image, np.array([[1.0, 0, left], [0, 1, top]]), (320, 240))
    return moved, Box(float(x + left), 60.0 + top, W, H)


def walked(ways=None, gray=False, told=True):
    """A background after a figure has walked to the post in 20 steps, and the camera its ways."""
    ways = [(0, 0)] * 20 if ways is None else ways
    background, before = Background((240, 320), np.sqrt(W * H)), np.zeros(2)
    for x, way in zip(range(60, 160, 5), ways, strict=True):
        if told:
            background.move(np.array(way) - before)
        before = np.array(way)
        image, box = view(x, way)
        background.remember(image[..., 1] if gray else image, box, DT)
    return background


@pytest.mark.parametrize("gray", [False, True])
def test_what_stood_there_before_is_told_from_the_target(gray):
    background = walked(gray=gray)
    hidden, _ = view(0, figure=False)
    come, there = view(int(POST.x))
    if gray:
        hidden, come = hidden[..., 1], come[..., 1]
    assert background.shows(hidden, POST)
    assert not background.shows(come, there)


def test_it_is_found_where_the_camera_has_moved_it_to():
    ways = [(-8 * k, k) for k in range(20)]
    background = walked(ways)
    hidden, _ = view(0, ways[-1], figure=False)
    moved = Box(POST.x + ways[-1][0], POST.y + ways[-1][1], W, H)
    assert background.shows(hidden, moved)
    still = walked(ways, told=False)
    assert not still.shows(hidden, moved)


def test_before_anything_of_it_is_old_it_is_compared_with_what_was_given():
    """It comes within half a second to where something of its own look stands."""
    background = Background((240, 320), np.sqrt(W * H))
    for x in (120, 140, 160, 180, 200):
        image, box = view(x)
        image[60 : 60 + H, int(POST.x) : int(POST.x) + W] = FIGURE
        if x < POST.x:
            background.remember(image, box, DT)
    assert not background.shows(image, box)


def test_the_target_that_stood_there_itself_has_not_stood_there_before():
    """What stands still, is covered and seen again is where it was."""
    background = Background((240, 320), np.sqrt(W * H))
    image, box = view(120)
    for _ in range(20):
        background.remember(image, box, DT)
    assert not background.shows(image, box)


def test_nothing_is_known_of_a_scene_just_seen():
    background = Background((240, 320), np.sqrt(W * H))
    image, box = view(60)
    background.remember(image, box, DT)
    assert not background.shows(view(0, figure=False)[0], POST)


@pytest.mark.parametrize(
    ("shape", "box"),
    [
        ((120, 160, 3), POST),
        ((240, 320), POST),
        ((240, 320, 3), Box(200.0, 60.0, 1.0, 1.0)),
        ((240, 320, 3), Box(-500.0, -500.0, W, H)),
    ],
    ids=["another size", "another kind", "too small", "outside"],
)
def test_what_cannot_be_compared_is_not_known(shape, box):
    assert not walked().shows(np.zeros(shape, np.uint8), box)


def test_it_keeps_no_more_than_some_keyframes():
    """A minute of a large image: its keyframes are a hundredth of one image together."""
    background, image = Background((2000, 3000), 8.0), np.zeros((2000, 3000, 3), np.uint8)
    tracemalloc.start()
    try:
        for _ in range(60):
            background.remember(image, Box(0.0, 0.0, 8.0, 8.0), 1.0)
        kept = tracemalloc.get_traced_memory()[0]
    finally:
        tracemalloc.stop()
    longest = BackgroundConfig().longest_side
    assert 0 < kept < 1.1 * BackgroundConfig().kept * 3 * longest * longest * 2 / 3


def test_best_fit_is_the_best_of_all_shifts():
    rng = np.random.default_rng(3)
    pixels = rng.integers(0, 256, (30, 40), np.uint8)
    patch = pixels[11:19, 13:20]
    corner, error = np.array([11.0, 12.0]), np.array([3.0, 3.0])

    def correlation(x, y):
        there = pixels[y : y + 8, x : x + 7].astype(float)
        return np.corrcoef(there.ravel(), patch.ravel().astype(float))[0, 1]

    every = max(correlation(11 + x, 12 + y) for x in range(-3, 4) for y in range(-3, 4))
    assert best_fit(pixels, corner, patch, error) == pytest.approx(every, abs=1e-5)
    assert best_fit(pixels, np.array([60.0, 5.0]), patch, error) is None


def test_a_column_that_hides_the_target_is_not_followed():
    config = SceneConfig(story="hidden_2s", seed=5, rate=15.0, width=320, height=240)
    moments = followed(config, TrackerConfig())
    assert honesty(moments, config.rate).confident_wrong < 5
