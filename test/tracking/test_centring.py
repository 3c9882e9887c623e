# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import numpy as np
import pytest

from het_ros import Box, HierarchicalEnsembleTracker, TrackerConfig
from het_ros.tracking.centring import Centring, best_place, contrast

CELLS = (16.0, 24.0)
SIZE = (16, 24)
CENTRE = np.array([40.0, 50.0])
OFF = TrackerConfig(centring=False)


def outline(by, size=SIZE, shape=(100, 80)):
    """A likelihood that is high where a target off CENTRE ``by`` (x, y) cells is."""
    (x, y), (width, height) = CENTRE + by, size
    likelihood = np.full(shape, 0.2, np.float32)
    likelihood[
        round(y - height / 2) : round(y + height / 2), round(x - width / 2) : round(x + width / 2)
    ] = 0.8
    return likelihood


def centred(likelihood, frames=400):
    """The offset after a target was found at CENTRE in many frames."""
    centring = Centring(CELLS)
    for _ in range(frames):
        centring.observe(likelihood, CENTRE + centring.offset)
    return centring.offset


def slow_contrast(likelihood, size):
    """As it is defined, px by px."""
    (width, height), ring = size, [max(1, round(0.15 * side)) for side in size]
    padded = np.pad(likelihood, 50, mode="edge")
    values = np.empty((height + 1, width + 1))
    for row in range(height + 1):
        for column in range(width + 1):
            top, left = row + 50, column + 50
            wide = padded[
                top - ring[1] : top + height + ring[1], left - ring[0] : left + width + ring[0]
            ]
            box = padded[top : top + height, left : left + width]
            around = (wide.sum() - box.sum()) / (wide.size - box.size)
            values[row, column] = box.mean() - around
    return values


@pytest.mark.parametrize("size", [(16, 24), (5, 8), (9, 4), (1, 1)])
def test_contrast_is_what_it_says(size):
    likelihood = np.random.default_rng(0).random((2 * size[1], 2 * size[0]), np.float32)
    found = contrast(likelihood, size)
    assert found.shape == (size[1] + 1, size[0] + 1)
    np.testing.assert_allclose(found, slow_contrast(likelihood, size), atol=1e-5)


@pytest.mark.parametrize("by", [(0, 0), (3, 0), (-3, 0), (0, 5), (2, -4)])
def test_the_best_place_is_where_the_outline_is(by):
    width, height = SIZE
    likelihood = outline(by)[50 - height : 50 + height, 40 - width : 40 + width]
    np.testing.assert_allclose(best_place(contrast(likelihood, SIZE)), by, atol=0.6)


@pytest.mark.parametrize(("by", "least"), [((3, 0), (2, 0)), ((-3, 0), (-2, 0)), ((0, 5), (0, 1))])
def test_a_target_that_lies_beside_what_was_given_is_moved_to(by, least):
    offset = centred(outline(by))
    assert (np.abs(offset) <= np.abs(by) + np.array([0.5, 0.5])).all()
    assert (np.abs(offset) >= np.abs(least)).all()
    assert (offset * by >= 0).all()


def test_what_lies_right_is_left_alone():
    np.testing.assert_allclose(centred(outline((0, 0))), 0, atol=0.3)


def test_colours_that_say_nothing_move_nothing():
    np.testing.assert_allclose(centred(np.full((100, 80), 0.5, np.float32)), 0, atol=1e-3)


def test_it_is_never_moved_far():
    likelihood = np.zeros((100, 80), np.float32)
    likelihood[:, 60:] = 1.0
    assert np.abs(centred(likelihood) / CELLS).max() <= 0.25


def test_what_covers_half_for_a_while_moves_it_little():
    centring = Centring(CELLS)
    for _ in range(300):
        centring.observe(outline((0, 0)), CENTRE + centring.offset)
    before = centring.offset
    for _ in range(30):
        centring.observe(outline((4, 0), (8, 24)), CENTRE + centring.offset)
    assert np.abs(centring.offset - before).max() < 0.1 * CELLS[0]


def overlap_of(frames, config, shift, count=60):
    """Mean overlap in the second half of a run whose start box was moved by parts of its size."""
    first = frames.boxes[0]
    box = Box(first.x + shift[0] * first.w, first.y + shift[1] * first.h, first.w, first.h)
    tracker = HierarchicalEnsembleTracker(config)
    tracker.init(frames.image(0), box)
    boxes = [tracker.update(frames.image(i), 1 / 30).box for i in range(1, count)]
    pairs = list(zip(boxes, frames.boxes[1:count], strict=True))
    return np.mean([box.iou(truth) for box, truth in pairs[count // 2 :]])


@pytest.mark.parametrize("name", ["David", "Jogging-1"])
def test_starts_beside_a_real_target_are_mended(name, sequence):
    frames = sequence(name)
    corners = [(x, y) for x in (-0.1, 0.1) for y in (-0.1, 0.1)]
    mended, left = (
        np.mean([overlap_of(frames, config, shift) for shift in corners])
        for config in (TrackerConfig(), OFF)
    )
    assert mended > left + 0.01


def test_without_colours_or_judgement_there_is_none(noise):
    for config in (
        replace(TrackerConfig(), colour_weight=0.0),
        replace(TrackerConfig(), trust=False),
    ):
        boxes = []
        for one in (config, replace(config, centring=False)):
            tracker = HierarchicalEnsembleTracker(one)
            tracker.init(noise, Box(50, 40, 30, 40))
            boxes.append([tracker.update(noise, 1 / 30).box for _ in range(12)])
        assert boxes[0] == boxes[1]
