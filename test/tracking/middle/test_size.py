# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The size by flow and scale filter together, against formulas and known zooms."""

import math

import numpy as np
import pytest

from het_ros.tracking.bottom.flow import Flow
from het_ros.tracking.features.channels import channel_stack
from het_ros.tracking.features.compressive import FeatureMaps
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.features.window import Window, cut_window
from het_ros.tracking.middle.size import Size

DT = 1 / 30
CHANGE, BY_FLOW, MOST_BY_FLOW = 0.02, 0.35, 0.1
NO_FEATURES: FeatureMaps = np.zeros((1, 1, 1), np.float32)
CENTRE = np.array([20.0, 15.0])
CELLS = (12, 16)


def frame_of(pixels):
    window = Window(pixels, (0.0, 0.0), (1.0, 1.0))
    return Frame.of(window, channel_stack(pixels, ("lightness", "gradient")), NO_FEATURES)


@pytest.fixture
def still():
    pixels = np.random.default_rng(4).integers(0, 256, (30, 40, 3), np.uint8)
    return frame_of(pixels)


def flow(growth, deviation=0.0):
    return Flow(np.zeros(2), np.zeros(2), 1.0, growth, deviation)


def size_of(still, first=(60.0, 80.0), limit=0.0):
    size = Size(np.array(first), CELLS, 0.02, 0.1, limit)
    size.learn(still, CENTRE, 1.0, 1.0)
    return size


@pytest.mark.parametrize("deviation", [0.0, 0.05, 0.5])
@pytest.mark.parametrize("growth", [-0.3, -0.03, 0.0, 0.02, 0.3])
def test_flow_is_believed_as_far_as_it_is_certain(still, growth, deviation):
    size = size_of(still)
    believed = growth * CHANGE**2 / (CHANGE**2 + (BY_FLOW * deviation) ** 2)
    wanted = math.exp(min(max(believed, -MOST_BY_FLOW), MOST_BY_FLOW))
    assert size.follow(still, CENTRE, flow(growth, deviation), DT) == pytest.approx(wanted)
    np.testing.assert_allclose(size.size, wanted * np.array([60.0, 80.0]))


def test_without_flow_and_with_no_limit_left_the_size_stays(still):
    size = size_of(still)
    assert size.follow(still, CENTRE, None, DT) == 1.0
    np.testing.assert_array_equal(size.size, [60.0, 80.0])


@pytest.mark.parametrize(("side", "shrinks"), [(2.9, False), (30.0, True)])
def test_a_target_of_a_few_px_does_not_shrink(still, side, shrinks):
    size = size_of(still, (side, 40.0))
    assert (size.follow(still, CENTRE, flow(-0.05), DT) < 1) is shrinks
    assert size.follow(still, CENTRE, flow(0.05), DT) > 1


@pytest.mark.parametrize(("learnt", "share"), [(0, 1 / 15), (7, 8 / 15), (40, 1.0)], ids=str)
def test_the_filter_changes_it_no_faster_than_the_limit(sequence, learnt, share):
    """A zoom of 1.15 is more than a frame may grow; the first frames are followed less."""
    frames, limit = sequence("David"), 0.42
    image, box = frames.image(0), frames.boxes[0]
    first, centre = look(image, box, 1.0)
    zoomed, _ = look(image, box, 1.15)
    size = Size(np.array([box.w, box.h]), cells_of(box), 0.0, 0.1, limit)
    for _ in range(1 + learnt):
        size.learn(first, centre, 1.0, 1.0)
    ratio = size.follow(zoomed, centre, None, DT)
    assert ratio == pytest.approx(math.exp(limit * DT * share))


@pytest.mark.parametrize("zoom", [0.95, 1.0, 1.05])
def test_a_known_zoom_is_found_in_the_long_run(sequence, zoom):
    """Flow that says nothing leaves the scale filter, at 5 % a frame, to find it."""
    frames = sequence("Couple")
    image, box = frames.image(0), frames.boxes[0]
    size = Size(np.array([box.w, box.h]), cells_of(box), 0.0, 0.1, 0.05 / DT)
    first, centre = look(image, box, 1.0)
    for _ in range(16):
        size.learn(first, centre, 1.0, 1.0)
    for _ in range(6):
        seen, _ = look(image, box, zoom * box.w / size.size[0])
        size.follow(seen, centre, None, DT)
    np.testing.assert_allclose(size.size / (box.w, box.h), zoom, atol=0.02)


def cells_of(box):
    width, height = 24 * np.array([box.w, box.h]) / math.sqrt(box.area)
    return round(width), round(height)


def look(image, box, zoom):
    """The target in cells, ``zoom`` times as large as in its first look; and its centre."""
    scale = zoom * 48 / math.sqrt(box.area)
    half = 1.1 * 48 * np.array([box.w, box.h]) / math.sqrt(box.area)
    width, height = np.ceil(2 * half).astype(int)
    x, y = np.array(box.centre) - half / scale
    window = cut_window(image, x, y, int(width), int(height), (scale, scale))
    channels = channel_stack(window.pixels, ("lightness", "green_red", "gradient"), 2)
    return Frame.of(window.in_cells(2), channels, NO_FEATURES), half / 2
