# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.features.frame import stacked
from het_ros.tracking.middle.grid_means import Normalisation, grid_means

RNG = np.random.default_rng(4)
PLANES = tuple(RNG.integers(0, 256, (30, 40), np.uint8) for _ in range(3))
STACK = stacked(PLANES)


@pytest.mark.parametrize(
    ("centre", "sides", "grid"),
    [
        ((20.0, 14.0), [(16, 8)], (2, 2)),
        ((20.0, 14.0), [(16, 8), (32, 24), (8, 16)], (4, 4)),
        ((13.0, 15.0), [(10, 14), (6, 2)], (1, 1)),
        ((13.5, 15.5), [(9, 15), (27, 21)], (3, 3)),
        ((4.0, 4.0), [(8, 8)], (4, 4)),  # up to the corner
        ((20.0, 14.0), [(16, 8), (8, 24)], (4, 2)),
        (((20.0, 14.0), (13.0, 15.0)), [(16, 8), (8, 4)], (2, 4)),  # each at its own place
    ],
)
def test_grid_means_of_whole_px(centre, sides, grid):
    found = grid_means(STACK, np.array(centre), np.array(sides, float), grid)
    assert found.shape == (len(sides), grid[1], len(PLANES), grid[0])
    centres = np.broadcast_to(centre, (len(sides), 2))
    for s, (width, height) in enumerate(sides):
        left, top = centres[s] - (width / 2, height / 2)
        for c, plane in enumerate(PLANES):
            for row in range(grid[1]):
                for column in range(grid[0]):
                    xs = [int(left + width * (column + k) / grid[0]) for k in (0, 1)]
                    ys = [int(top + height * (row + k) / grid[1]) for k in (0, 1)]
                    wanted = plane[ys[0] : ys[1], xs[0] : xs[1]].mean()
                    assert found[s, row, c, column] == pytest.approx(wanted, rel=1e-3)


@pytest.mark.parametrize("part", [0.25, 0.5, 0.9])
def test_between_whole_px_sums_are_interpolated(part):
    """The right side moves by a part of a px: the sum grows by that part of the column."""
    left, top, width, height = 5, 6, 7, 8

    def total(wide):
        centre = np.array([left + wide / 2, top + height / 2])
        mean = grid_means(STACK, centre, np.array([[wide, height]], float), (1, 1))[0, 0, :, 0]
        return mean * wide * height

    wanted = (1 - part) * total(width) + part * total(width + 1)
    np.testing.assert_allclose(total(width + part), wanted, rtol=1e-3)


def test_a_flat_image_has_the_same_mean_at_every_size():
    flat = np.full((30, 1, 40), 77, np.float32)
    sides = np.array([[3.3, 5.1], [11.7, 9.9], [20.2, 24.6]])
    found = grid_means(flat, np.array([20.3, 14.6]), sides, (4, 4))
    np.testing.assert_allclose(found, 77, rtol=0.01)


@pytest.mark.parametrize("centre", [(-50.0, 3.0), (300.0, 300.0), (0.0, 30.0)], ids=str)
def test_what_lies_outside_counts_as_empty(centre):
    found = grid_means(STACK, np.array(centre), np.array([[12.0, 20.0]]), (4, 4))
    assert np.isfinite(found).all()
    if max(map(abs, centre)) > 40:
        np.testing.assert_allclose(found, 0, atol=1e-6)


def test_the_first_means_set_the_normalisation():
    first, later = RNG.random((2, 3, 4, 2, 4)).astype(np.float32) * 100
    normalisation = Normalisation()
    features = normalisation.features(first), normalisation.features(later)
    for means, found in zip((first, later), features, strict=True):
        for s, row, channel, column in np.ndindex(means.shape):
            value = means[s, row, channel, column] - first[:, row, channel, column].mean()
            wanted = value / (first[:, :, channel].std() + 1)
            assert found[s, (row * 2 + channel) * 4 + column] == pytest.approx(wanted, abs=1e-5)
