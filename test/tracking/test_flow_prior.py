# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros import Box, TrackerConfig
from het_ros.tracking.flow_prior import FlowPrior
from het_ros.tracking.window import cut_window

CONFIG = TrackerConfig(cell=2, flow_weight=0.25)
CELLS = (16.0, 16.0)
BOX = Box(40.0, 40.0, 32.0, 32.0)
CENTRE = np.array(BOX.centre)
MIDDLE = np.array(CELLS) / 2
SHAPE = (45, 45)  # places of the target's corner in the window, cells


@pytest.fixture
def picture():
    noise = np.random.default_rng(0).integers(0, 256, (120, 120, 3), dtype=np.uint8)
    return cv2.GaussianBlur(noise, (0, 0), 2)


def window_of(image):
    return cut_window(image, 0.0, 0.0, 120, 120, (1.0, 1.0)).in_cells(CONFIG.cell)


def shifted(image, dx, dy):
    matrix = np.array([[1, 0, dx], [0, 1, dy]], np.float32)
    return cv2.warpAffine(image, matrix, image.shape[1::-1], borderMode=cv2.BORDER_REFLECT)


@pytest.mark.parametrize("shift", [(0, 0), (6, -4), (-4, 2)])
def test_the_place_where_the_pixels_went_weighs_most(picture, shift):
    prior = FlowPrior(CONFIG, CELLS)
    prior.remember(window_of(picture), BOX, 1 / 30)
    weights = prior.over(window_of(shifted(picture, *shift)), CENTRE, SHAPE, MIDDLE)
    row, column = np.unravel_index(weights.argmax(), SHAPE)
    assert (column, row) == ((40 + shift[0]) / 2, (40 + shift[1]) / 2)
    assert weights.min() >= 1
    assert 1.2 < weights.max() <= 1.25


def test_without_flow_all_places_weigh_the_same(picture):
    unknown = FlowPrior(CONFIG, CELLS)
    off = FlowPrior(TrackerConfig(cell=2, flow_weight=0.0), CELLS)
    off.remember(window_of(picture), BOX, 1 / 30)
    for prior in (unknown, off):
        assert (prior.over(window_of(picture), CENTRE, SHAPE, MIDDLE) == 1).all()


def test_who_is_just_back_is_not_followed_by_flow_at_once(picture):
    prior = FlowPrior(CONFIG, CELLS)
    prior.forget()
    used = []
    for _ in range(6):
        prior.remember(window_of(picture), BOX, 0.25)
        used.append(prior.over(window_of(picture), CENTRE, SHAPE, MIDDLE).max() > 1)
    assert used == [False] * 4 + [True] * 2


@pytest.mark.parametrize(("score", "share"), [(1.0, 1.0), (0.5, 1.0), (0.25, 0.5), (0.0, 0.0)])
def test_flow_from_a_doubtful_place_weighs_less(picture, score, share):
    prior, sure = FlowPrior(CONFIG, CELLS), FlowPrior(CONFIG, CELLS)
    prior.remember(window_of(picture), BOX, 1 / 30, score)
    sure.remember(window_of(picture), BOX, 1 / 30)
    gained, most = (
        p.over(window_of(picture), CENTRE, SHAPE, MIDDLE).max() - 1 for p in (prior, sure)
    )
    assert gained == pytest.approx(share * most, abs=1e-6)
