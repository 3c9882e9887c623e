# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import cv2
import numpy as np
import pytest

from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.gray import bgr_of, deviation, gray_of, is_colourless
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

NOISE = np.random.default_rng(0).integers(0, 256, (120, 160), np.uint8)


def tinted(by: int) -> np.ndarray:
    """Gray noise of which one channel is brighter."""
    image = bgr_of(NOISE // 2)
    image[..., 2] += np.uint8(by)
    return image


@pytest.mark.parametrize(
    ("image", "colourless"),
    [
        (NOISE, True),
        (bgr_of(NOISE), True),
        (tinted(1), True),
        (tinted(3), False),
        (np.zeros((1, 1, 3), np.uint8), True),
        (np.full((1, 3000, 3), (0, 0, 9), np.uint8), False),
    ],
    ids=["one channel", "three alike", "nearly alike", "tinted", "one px", "one row"],
)
def test_what_counts_as_gray(image, colourless):
    assert is_colourless(image, 2.0) is colourless


def test_nothing_of_three_channels_is_gray_below_zero():
    assert not is_colourless(bgr_of(NOISE), 0.0)
    assert is_colourless(NOISE, 0.0)


@pytest.mark.parametrize(
    ("name", "gray"), [("Dog1", True), ("Car1", True), ("Woman", False), ("UAV-person11", False)]
)
def test_real_cameras(sequence, name, gray):
    assert is_colourless(sequence(name).image(0), TrackerConfig().gray_below) is gray


def test_there_and_back():
    np.testing.assert_array_equal(gray_of(bgr_of(NOISE)), NOISE)
    assert gray_of(NOISE) is NOISE


def test_deviation_is_that_of_the_square_around():
    slow = [
        [NOISE[y - 2 : y + 3, x - 2 : x + 3].astype(float).std() for x in range(2, 158)]
        for y in range(2, 118)
    ]
    np.testing.assert_allclose(deviation(NOISE, 5)[2:-2, 2:-2], slow, rtol=1e-3)
    assert not deviation(np.full((9, 9), 255, np.uint8), 5).any()


def test_gray_in_three_channels_is_followed_as_in_one(sequence):
    frames = sequence("Crossing")
    one, three = HierarchicalEnsembleTracker(), HierarchicalEnsembleTracker()
    for i in range(12):
        gray = cv2.cvtColor(frames.image(i), cv2.COLOR_BGR2GRAY)
        if i == 0:
            estimates = one.init(gray, frames.boxes[0]), three.init(bgr_of(gray), frames.boxes[0])
        else:
            estimates = one.update(gray, 0.1), three.update(bgr_of(gray), 0.1)
        assert estimates[0].box == estimates[1].box
        assert estimates[0].score == estimates[1].score
