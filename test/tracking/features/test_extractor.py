# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From real images to frames: windows, channels and features that show the target."""

import numpy as np
import pytest

from het_ros.tracking.features.channels import names_for
from het_ros.tracking.features.compressive import draw_measurement_matrix
from het_ros.tracking.features.extractor import FeatureExtractor, WindowConfig, target_cells

from . import slow

RADIUS, FEATURES = 34.0, 12
WINDOW = WindowConfig()


def extractor(image, cells, patch=(6, 8), seed=0):
    return FeatureExtractor(
        image, cells, patch, FEATURES, RADIUS, 2.0, np.random.default_rng(seed)
    )


@pytest.mark.parametrize(
    ("size", "cells"),
    [
        ((40, 40), (24, 24)),
        ((17, 50), (14, 41)),
        ((0.1, 0.1), (24, 24)),
        ((3000, 1000), (42, 14)),
        ((1e3, 1.0), (759, 4)),  # never fewer than 4 cells a side
    ],
    ids=str,
)
def test_a_target_has_as_many_cells_whatever_its_size(size, cells):
    assert target_cells(size, 48.0) == cells


@pytest.mark.parametrize("name", ["David", "Crossing", "Couple"])
@pytest.mark.parametrize("gray", [False, True], ids=["colour", "gray"])
def test_the_features_of_a_real_frame_are_sums_of_its_channels(sequence, name, gray):
    frames = sequence(name)
    image, box = frames.image(0), frames.boxes[0]
    if gray:
        image = np.ascontiguousarray(image[..., 1])
    cells, patch = target_cells((box.w, box.h), 48.0), (6, 8)
    frame = extractor(image, cells, patch).look(
        image, np.array(box.centre), np.array([box.w, box.h])
    )
    names = names_for(WINDOW.channels, frame.window.pixels.ndim == 2)
    assert len(frame.channels) == len(names)
    matrix = draw_measurement_matrix(
        patch, len(names), FEATURES, WINDOW.rectangles, np.random.default_rng(0)
    )
    raw = slow.all_features(frame.channels, matrix.rows, patch)
    rows, columns = frame.features.shape[1:]
    table = np.array([[raw[x, y] for x in range(columns)] for y in range(rows)]).transpose(2, 0, 1)
    # The first frame sets the normalisation: its own features have mean 0 and deviation 1.
    flat = table.reshape(FEATURES, -1)
    wanted = (flat - np.rint(flat.mean(axis=1))[:, None]) / flat.std(axis=1)[:, None]
    np.testing.assert_allclose(frame.features.reshape(FEATURES, -1), wanted, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("zoom", [0.5, 1.0, 3.0])
def test_the_target_is_in_the_middle_at_its_own_scale(zoom):
    image = np.zeros((240, 320, 3), np.uint8)
    left, top, width, height = 150, 90, round(20 * zoom), round(30 * zoom)
    image[top : top + height, left : left + width] = 255
    size = np.array([width, height], float)
    cells = target_cells((20, 30), 48.0)
    frame = extractor(image, cells).look(image, np.array([left, top]) + size / 2, size)
    margin = WINDOW.margin_of(RADIUS)
    lightness = frame.channels[0]
    assert lightness.shape == (cells[1] + 2 * margin, cells[0] + 2 * margin)
    inside = lightness[margin : margin + cells[1], margin : margin + cells[0]]
    assert inside[1:-1, 1:-1].min() > 200
    outside = lightness.astype(int)
    outside[margin - 1 : margin + cells[1] + 1, margin - 1 : margin + cells[0] + 1] = 0
    assert outside.max() < 60
    corner = frame.window.to_window(np.array([left, top], float))
    np.testing.assert_allclose(corner, margin, atol=1e-9)


def test_a_window_reaches_as_far_as_it_says(noise):
    """A target at the end of the reach lies in the window with its margin of a cell."""
    size = np.array([20.0, 30.0])
    cells = target_cells(size, 48.0)
    eye = extractor(noise, cells)
    frame = eye.look(noise, np.array([80.0, 60.0]), size)
    first = frame.window.to_window(np.array([80.0, 60.0]) - eye.reach(size) - size / 2)
    np.testing.assert_allclose(first, WINDOW.margin, atol=1e-9)


@pytest.mark.parametrize("later", ["gray", "colour"])
@pytest.mark.parametrize("first", ["gray", "colour", "gray in three channels"])
def test_all_frames_are_of_the_kind_of_the_first(noise, first, later):
    gray = np.ascontiguousarray(noise[..., 1])
    images = {"gray": gray, "colour": noise, "gray in three channels": np.dstack([gray] * 3)}
    eye = extractor(images[first], (20, 30))
    frame = eye.look(images[later], np.array([80.0, 60.0]), np.array([20.0, 30.0]))
    assert eye.gray is (first != "colour")
    assert frame.window.pixels.ndim == (2 if eye.gray else 3)
    assert len(frame.channels) == len(names_for(WINDOW.channels, eye.gray))


@pytest.mark.parametrize("shape", [(1, 1, 3), (1, 160, 3), (120, 1), (37, 5, 3)], ids=str)
@pytest.mark.parametrize("centre", [(0.0, 0.0), (-300.0, 40.0), (1e5, 1e5)], ids=str)
def test_any_place_of_any_image_gives_a_frame(noise, shape, centre):
    eye = extractor(noise, (20, 30))
    frame = eye.look(np.resize(noise, shape), np.array(centre), np.array([20.0, 30.0]))
    assert frame.features.shape == (FEATURES, 66 - 8 + 1, 56 - 6 + 1)
    assert np.isfinite(frame.features).all()


def test_what_was_seen_is_not_written_by_a_later_look(noise):
    eye, size = extractor(noise, (20, 30)), np.array([20.0, 30.0])
    first = eye.look(noise, np.array([80.0, 60.0]), size)
    kept = first.features.copy(), [channel.copy() for channel in first.channels]
    for shift in range(1, 4):
        eye.look(np.roll(noise, 9 * shift, axis=1), np.array([70.0, 50.0]), size)
    np.testing.assert_array_equal(first.features, kept[0])
    np.testing.assert_array_equal(first.channels, kept[1])
