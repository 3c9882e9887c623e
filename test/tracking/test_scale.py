# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.channels import channel_stack
from het_ros.tracking.scale import ScaleFilter, grid_means
from het_ros.tracking.window import cut_window

RNG = np.random.default_rng(4)
PLANES = tuple(RNG.integers(0, 256, (30, 40), np.uint8) for _ in range(3))
CHANNELS = ("lightness", "green_red", "blue_yellow", "gradient")


@pytest.mark.parametrize(
    ("centre", "sides", "grid"),
    [
        ((20.0, 14.0), [(16, 8)], 2),
        ((20.0, 14.0), [(16, 8), (32, 24), (8, 16)], 4),
        ((13.0, 15.0), [(10, 14), (6, 2)], 1),
        ((13.5, 15.5), [(9, 15), (27, 21)], 3),
        ((4.0, 4.0), [(8, 8)], 4),  # up to the corner
    ],
)
def test_grid_means_of_whole_px(centre, sides, grid):
    found = grid_means(PLANES, np.array(centre), np.array(sides, float), grid)
    assert found.shape == (len(sides), grid, len(PLANES), grid)
    for s, (width, height) in enumerate(sides):
        left, top = centre[0] - width / 2, centre[1] - height / 2
        for c, plane in enumerate(PLANES):
            for row in range(grid):
                for column in range(grid):
                    xs = [int(left + width * (column + k) / grid) for k in (0, 1)]
                    ys = [int(top + height * (row + k) / grid) for k in (0, 1)]
                    wanted = plane[ys[0] : ys[1], xs[0] : xs[1]].mean()
                    assert found[s, row, c, column] == pytest.approx(wanted, rel=1e-3)


@pytest.mark.parametrize("part", [0.25, 0.5, 0.9])
def test_between_whole_px_sums_are_interpolated(part):
    """The right side moves by a part of a px: the sum grows by that part of the column."""
    left, top, width, height = 5, 6, 7, 8

    def total(wide):
        centre = np.array([left + wide / 2, top + height / 2])
        mean = grid_means(PLANES, centre, np.array([[wide, height]], float), 1)[0, 0, :, 0]
        return mean * wide * height

    wanted = (1 - part) * total(width) + part * total(width + 1)
    np.testing.assert_allclose(total(width + part), wanted, rtol=1e-3)


def test_a_flat_image_has_the_same_mean_at_every_size():
    flat = (np.full((30, 40), 77, np.uint8),)
    sides = np.array([[3.3, 5.1], [11.7, 9.9], [20.2, 24.6]])
    found = grid_means(flat, np.array([20.3, 14.6]), sides, 4)
    np.testing.assert_allclose(found, 77, rtol=0.01)


@pytest.mark.parametrize("centre", [(-50.0, 3.0), (300.0, 300.0), (0.0, 30.0)], ids=str)
def test_what_lies_outside_counts_as_empty(centre):
    found = grid_means(PLANES, np.array(centre), np.array([[12.0, 20.0]]), 4)
    assert np.isfinite(found).all()
    if max(map(abs, centre)) > 40:
        np.testing.assert_allclose(found, 0, atol=1e-6)


def test_channels_are_left_as_they_are():
    before = [plane.copy() for plane in PLANES]
    scale = ScaleFilter((12, 16), 9, 1.03, 1.2, 0.1)
    scale.learn(PLANES, np.array([20.0, 15.0]), 1.0)
    scale.change(PLANES, np.array([20.0, 15.0]))
    for plane, old in zip(PLANES, before, strict=True):
        np.testing.assert_array_equal(plane, old)


def planes_of(image, box, zoom, side=48):
    """The window around a box, in which the target appears ``zoom`` times as large."""
    scale = zoom * side / np.sqrt(box.area)
    half = 1.1 * side * np.array([box.w, box.h]) / np.sqrt(box.area)
    width, height = np.ceil(2 * half).astype(int)
    x, y = np.array(box.centre) - half / scale
    window = cut_window(image, x, y, int(width), int(height), (scale, scale))
    return channel_stack(window.pixels, CHANNELS, 2), half / 2


@pytest.mark.parametrize("zoom", [0.94, 0.96, 0.98, 1.0, 1.02, 1.04, 1.06])
@pytest.mark.parametrize("name", ["David", "Crossing", "Couple", "Car1"])
def test_a_known_zoom_of_a_real_frame_is_found(sequence, name, zoom):
    """At once the filter goes part of the way, in a few frames all of it to within a step."""
    frames = sequence(name)
    image, box = frames.image(0), frames.boxes[0]
    size = 24 * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = ScaleFilter((round(size[0]), round(size[1])), 17, 1.02, 1.2, 0.02)
    planes, centre = planes_of(image, box, 1.0)
    scale.learn(planes, centre, 1.0)
    growth, ratios = 1.0, []
    for _ in range(6):
        planes, centre = planes_of(image, box, zoom / growth)
        ratios.append(scale.change(planes, centre))
        growth *= ratios[-1]
    assert growth == pytest.approx(zoom, abs=0.02)
    least, most = sorted((1.0, zoom))
    assert least - 0.005 <= ratios[0] <= most + 0.005


def test_a_target_that_grows_and_shrinks_is_followed(sequence):
    """The filter learns at the size it found, as the tracker has it do, and does not drift."""
    frames = sequence("David")
    image, box = frames.image(0), frames.boxes[0]
    size = 24 * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = ScaleFilter((round(size[0]), round(size[1])), 17, 1.02, 1.2, 0.1)
    planes, centre = planes_of(image, box, 1.0)
    scale.learn(planes, centre, 1.0)
    growth = 1.0
    for zoom in [*np.linspace(1, 1.3, 15), *np.linspace(1.3, 0.9, 20)]:
        planes, centre = planes_of(image, box, zoom / growth)
        ratio = scale.change(planes, centre)
        scale.learn(planes, centre, ratio)
        growth *= ratio
        assert growth == pytest.approx(zoom, rel=0.06)


def test_nothing_to_see_keeps_the_size():
    flat = (np.full((30, 40), 77, np.uint8),)
    scale = ScaleFilter((12, 16), 17, 1.02, 1.2, 0.1)
    scale.learn(flat, np.array([20.0, 15.0]), 1.0)
    ratio = scale.change(flat, np.array([20.0, 15.0]))
    assert 1.02**-8 <= ratio <= 1.02**8  # whatever it is, no farther than it looked


@pytest.mark.parametrize(("share", "kept"), [(0.0, False), (0.5, True)])
def test_the_first_frame_is_kept(sequence, share, kept):
    """After hundreds of frames of something else the first frame's size is known or forgotten."""
    frames = sequence("David")
    image, box = frames.image(0), frames.boxes[0]
    size = 24 * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = ScaleFilter((round(size[0]), round(size[1])), 17, 1.02, 1.2, 0.05, share)
    planes, centre = planes_of(image, box, 1.0)
    larger, _ = planes_of(image, box, 1.06)
    scale.learn(planes, centre, 1.0)
    for _ in range(200):  # the same target at another size, taken for the present one
        scale.learn(larger, centre, 1.0)
    off = abs(scale.change(larger, centre) - 1)
    assert (off > 0.005) is kept
