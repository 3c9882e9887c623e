# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from het_ros import Box, TrackerConfig
from het_ros.tracking.size import Size
from het_ros.tracking.template import Template
from het_ros.tracking.template_size import size_slope

CELLS = (24.0, 24.0)
CENTRE = np.array([48.0, 48.0])
DT = 1 / 30


def planes(growth=1.0):
    """Three channels (96, 96) of noise, seen ``growth`` times as large about the centre."""
    rng = np.random.default_rng(3)
    to_source = np.array([[1 / growth, 0, 48 - 48 / growth], [0, 1 / growth, 48 - 48 / growth]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    noise = (rng.integers(0, 256, (96, 96), np.uint8) for _ in range(3))
    smooth = (cv2.GaussianBlur(plane, (0, 0), 2) for plane in noise)
    return tuple(cv2.warpAffine(plane, to_source, (96, 96), flags=flags) for plane in smooth)


def started(box, frames=20, **changes):
    """A size that has seen its target for some frames at the size of its first box."""
    size = Size(replace(TrackerConfig(), **changes), box, CELLS)
    size.learn(planes(), CENTRE, 1.0)
    for _ in range(frames):
        seen = planes(1 / size.growth)
        size.learn(seen, CENTRE, size.follow(seen, CENTRE, DT))
    return size


def test_the_box_has_the_size_of_the_first_one_times_the_growth():
    size = Size(TrackerConfig(), Box(10, 20, 30, 60), CELLS)
    assert size.box(CENTRE) == Box(33, 18, 30, 60)
    assert size.box(CENTRE, 2.0) == Box(18, -12, 60, 120)
    assert size.side(2.0) == pytest.approx(2 * math.sqrt(30 * 60))


def test_who_keeps_its_size_is_given_the_same_size():
    assert started(Box(0, 0, 40, 40)).growth == pytest.approx(1.0, abs=0.005)


@pytest.mark.parametrize("growth", [0.94, 0.97, 1.03, 1.06])
def test_a_change_of_size_is_found_in_a_few_frames(growth):
    size = started(Box(0, 0, 40, 40), growth_limit=100.0)
    for _ in range(8):
        # The target is looked for at the size it has by now.
        ratio = size.follow(planes(growth / size.growth), CENTRE, DT)
        assert (ratio - 1) * (growth - 1) > -0.002
    assert size.growth == pytest.approx(growth, abs=0.01)


@pytest.mark.parametrize(("growth", "sign"), [(1.2, 1), (0.8, -1)])
@pytest.mark.parametrize("dt", [DT, 0.1])
def test_it_changes_no_faster_than_the_limit(growth, sign, dt):
    size = started(Box(0, 0, 40, 40))
    limit = TrackerConfig().growth_limit
    assert size.follow(planes(growth), CENTRE, dt) == pytest.approx(math.exp(sign * limit * dt))


def test_the_first_frames_know_too_little_of_sizes_to_be_followed_in_full():
    ratios = []
    for frames in (0, 5, 14):
        ratios.append(started(Box(0, 0, 40, 40), frames).follow(planes(1.2), CENTRE, DT))
    assert 1 < ratios[0] < ratios[1] < ratios[2]
    assert ratios[2] == pytest.approx(math.exp(TrackerConfig().growth_limit * DT))


@pytest.mark.parametrize(("box", "least"), [(Box(0, 0, 4, 40), 3.0), (Box(0, 0, 2, 40), 2.0)])
def test_it_does_not_shrink_below_three_px_nor_grow_where_it_starts_below(box, least):
    size = started(box)
    for _ in range(200):
        size.follow(planes(0.9), CENTRE, 0.1)
    assert size.growth * box.w == pytest.approx(least, rel=0.03)


def test_with_one_size_nothing_changes():
    size = started(Box(0, 0, 40, 40), scales=1)
    assert size.follow(planes(1.2), CENTRE, DT) == 1.0
    assert size.growth == 1.0


def test_a_template_draws_the_size_beside_what_has_changed():
    """The picture stays as it is, but the base ensembles score more at a larger size."""
    drawn, left = started(Box(0, 0, 40, 40)), started(Box(0, 0, 40, 40))
    weights = np.random.default_rng(0).normal(size=(24, 3, 24)).astype(np.float32)
    template = Template(weights, 0.0)
    weights *= np.sign(size_slope(planes(), CENTRE, template))
    for _ in range(60):
        drawn.follow(planes(), CENTRE, DT, Template(weights, 0.0))
        left.follow(planes(), CENTRE, DT)
    assert drawn.growth != left.growth


@pytest.mark.parametrize("drawn", [0.98, 1.0, 1.02])
def test_the_first_frame_draws_the_size(drawn):
    size, alone = (started(Box(0, 0, 40, 40), growth_limit=100.0) for _ in range(2))
    ratio = size.follow(planes(), CENTRE, DT, drawn=drawn)
    assert ratio == pytest.approx(drawn * alone.follow(planes(), CENTRE, DT), rel=1e-6)


@pytest.mark.parametrize("both", [True, False])
def test_without_the_regression_the_filter_counts_in_full(both):
    size = started(Box(0, 0, 40, 40), size_regression=both, growth_limit=100.0)
    ratio = size.follow(planes(1.03), CENTRE, DT)
    alone = started(Box(0, 0, 40, 40), size_regression=False, growth_limit=100.0)
    assert (ratio == alone.follow(planes(1.03), CENTRE, DT)) is not both


@pytest.mark.parametrize(
    ("changes", "asked"), [({}, True), ({"size_template": False}, False), ({"scales": 1}, False)]
)
def test_a_template_is_asked_for_where_it_counts(changes, asked):
    size = Size(replace(TrackerConfig(), **changes), Box(0, 0, 40, 40), CELLS)
    assert any(size.asks_template() for _ in range(4)) is asked
