# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Known shifts and zooms of real frames are taken back in part; what is unlike leads nowhere."""

import numpy as np
import pytest

from het_ros.tracking.features.channels import channel_stack
from het_ros.tracking.features.window import cut_window
from het_ros.tracking.middle.alignment import AlignmentConfig, FirstFrameAlignment

CONFIG = AlignmentConfig()
CHANNELS = ("lightness", "green_red", "blue_yellow", "gradient")
NAMES = ["David", "Couple", "Car1"]


def planes_of(image, box, zoom=1.0, side=48):
    """Channels around a box, the target ``zoom`` times as large; its centre and size, cells."""
    scale = zoom * side / np.sqrt(box.area)
    half = 1.1 * side * np.array([box.w, box.h]) / np.sqrt(box.area)
    width, height = np.ceil(2 * half).astype(int)
    x, y = np.array(box.centre) - half / scale
    window = cut_window(image, x, y, int(width), int(height), (scale, scale))
    cells = np.round(0.5 * side * np.array([box.w, box.h]) / np.sqrt(box.area))
    return channel_stack(window.pixels, CHANNELS, 2), half / 2, cells


@pytest.fixture(params=NAMES)
def target(request, sequence):
    """Image and box of a real first frame, and the alignment to it."""
    frames = sequence(request.param)
    image, box = frames.image(0), frames.boxes[0]
    planes, centre, cells = planes_of(image, box)
    return image, box, FirstFrameAlignment(planes, centre, tuple(int(c) for c in cells))


def test_the_first_frame_itself_is_left_where_it_is(target):
    image, box, alignment = target
    planes, centre, _ = planes_of(image, box)
    found = alignment.correction(planes, centre)
    np.testing.assert_array_equal(found.shift, [0, 0])
    assert found.growth == 0


@pytest.mark.parametrize("away", [(0.08, 0.0), (0.0, -0.08), (-0.05, 0.05)])
def test_a_known_shift_is_taken_back_in_part(target, away):
    image, box, alignment = target
    planes, centre, cells = planes_of(image, box)
    off = away * cells
    found = alignment.correction(planes, centre + off)
    part = -(found.shift @ off) / (off @ off)
    assert 0.6 * CONFIG.shift < part < 1.2 * CONFIG.shift
    assert np.abs(found.shift + part * off).max() < 0.4 * np.abs(off).max()


@pytest.mark.parametrize("zoom", [0.92, 1.08])
def test_a_known_zoom_is_taken_back_in_part(target, zoom):
    image, box, alignment = target
    planes, centre, _ = planes_of(image, box, zoom)
    part = alignment.correction(planes, centre).growth / np.log(zoom)
    assert 0.5 * CONFIG.size < part < 1.3 * CONFIG.size


def test_repeated_it_arrives(target):
    image, box, alignment = target
    planes, centre, cells = planes_of(image, box)
    place = centre + 0.1 * cells
    for _ in range(12):
        place = place + alignment.correction(planes, place).shift
    np.testing.assert_allclose(place, centre, atol=0.02 * cells.max())


def test_what_is_unlike_the_first_frame_leads_nowhere(target):
    _, _, alignment = target
    rng = np.random.default_rng(3)
    planes = tuple(rng.integers(0, 256, (90, 90), np.uint8) for _ in CHANNELS)
    found = alignment.correction(planes, np.array([45.0, 45.0]))
    np.testing.assert_array_equal(found.shift, [0, 0])
    assert found.growth == 0


@pytest.mark.parametrize("level", [0, 128, 255])
def test_no_contrast_leads_nowhere(target, level):
    image, box, alignment = target
    flat = np.full_like(image, level)
    seen, centre, cells = planes_of(flat, box)
    of_flat = FirstFrameAlignment(seen, centre, tuple(int(c) for c in cells))
    shown, _, _ = planes_of(image, box)
    for one, planes in ((alignment, seen), (of_flat, shown), (of_flat, seen)):
        found = one.correction(planes, centre + 1.0)
        np.testing.assert_allclose(found.shift, [0, 0], atol=1e-6)
        assert abs(found.growth) < 1e-6
