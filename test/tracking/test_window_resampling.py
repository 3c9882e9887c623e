# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Windows at a resolution of their own, against each px looked up by itself."""

import cv2
import numpy as np
import pytest

from het_ros.tracking.window import cut_window


def slow_bilinear(image, x, y):
    """The image at a place in px counted from the middle of its first px, border repeated."""
    column, row = int(np.floor(x)), int(np.floor(y))
    total = 0.0
    for r, c, share in [
        (row, column, (1 - y + row) * (1 - x + column)),
        (row, column + 1, (1 - y + row) * (x - column)),
        (row + 1, column, (y - row) * (1 - x + column)),
        (row + 1, column + 1, (y - row) * (x - column)),
    ]:
        inside = image[np.clip(r, 0, image.shape[0] - 1), np.clip(c, 0, image.shape[1] - 1)]
        total = total + share * inside.astype(float)
    return total


@pytest.mark.parametrize("gray", [False, True], ids=["colour", "gray"])
@pytest.mark.parametrize("scale", [(2.5, 1.7), (1.3, 1.3), (0.9, 0.8)], ids=str)
@pytest.mark.parametrize("at", [(31.3, 22.8), (-4.4, 50.1), (100.0, 70.0)], ids=str)
def test_a_finer_window_is_interpolated(noise, at, scale, gray):
    image = noise[:, :, 0].copy() if gray else noise
    window = cut_window(image, *at, 24, 18, scale)
    assert window.pixels.shape[:2] == (18, 24)
    for row in range(0, 18, 3):
        for column in range(0, 24, 3):
            x = at[0] + (column + 0.5) / scale[0] - 0.5
            y = at[1] + (row + 0.5) / scale[1] - 0.5
            np.testing.assert_allclose(
                window.pixels[row, column], slow_bilinear(image, x, y), atol=4
            )


@pytest.mark.parametrize("degrees", [-170, -33, 0.5, 20, 90])
@pytest.mark.parametrize("at", [(61.3, 42.8), (-4.4, 50.1), (150.0, 110.0)], ids=str)
def test_a_turned_window_is_interpolated(noise, at, degrees):
    """Each px lies where ``to_image`` says, and its place leads back."""
    window = cut_window(noise, *at, 24, 18, (1.5, 1.2), np.radians(degrees))
    assert window.pixels.shape[:2] == (18, 24)
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    for row in range(0, 18, 4):
        for column in range(0, 24, 4):
            right, down = (column + 0.5) / 1.5, (row + 0.5) / 1.2
            x, y = at[0] + cosine * right - sine * down, at[1] + sine * right + cosine * down
            np.testing.assert_allclose(
                window.pixels[row, column], slow_bilinear(noise, x - 0.5, y - 0.5), atol=4
            )
            place = window.to_image(np.array([column + 0.5, row + 0.5]))
            np.testing.assert_allclose(place, (x, y))
            np.testing.assert_allclose(window.to_window(place), (column + 0.5, row + 0.5))


def test_a_coarse_turned_window_is_averaged():
    """A picture turned by a quarter and cut out turned by a quarter is as it was."""
    noise = np.random.default_rng(2).integers(0, 256, (20, 20, 3), np.uint8)
    image = cv2.resize(noise, (400, 400), interpolation=cv2.INTER_LINEAR)
    upright = cut_window(image, 40.0, 60.0, 40, 30, (0.125, 0.125)).pixels
    clockwise = np.ascontiguousarray(np.rot90(image, -1))
    window = cut_window(clockwise, 400.0 - 60.0, 40.0, 40, 30, (0.125, 0.125), np.pi / 2)
    np.testing.assert_allclose(window.pixels.astype(int), upright, atol=16)


@pytest.mark.parametrize("scale", [0.5, 0.25, 0.12])
def test_a_coarser_window_is_averaged(scale):
    """Noise far finer than a window px leaves its mean, and little of its deviation."""
    rng = np.random.default_rng(1)
    fine = rng.integers(0, 256, (600, 800), np.uint8)
    window = cut_window(fine, 100.3, 80.6, 40, 30, (scale, scale))
    assert window.pixels.mean() == pytest.approx(fine.mean(), abs=6)
    assert window.pixels.std() < 0.75 * fine.std()


@pytest.mark.parametrize(
    "scale",
    [(3.0, 2.0), (0.7, 0.7), (0.3, 0.2), (0.02, 0.02)],
    ids=str,
)
@pytest.mark.parametrize(
    "at", [(-5000.0, 3.0), (5000.0, 3.0), (3.0, -5000.0), (3.0, 5000.0), (-3.3, -2.2)], ids=str
)
def test_windows_over_the_border_and_wholly_outside(at, scale):
    flat = np.full((60, 80, 3), 90, np.uint8)
    window = cut_window(flat, *at, 25, 19, scale)
    assert window.pixels.shape == (19, 25, 3)
    np.testing.assert_array_equal(window.pixels, 90)


@pytest.mark.parametrize("shape", [(1, 1), (1, 90), (90, 1), (2, 3)], ids=str)
@pytest.mark.parametrize("scale", [4.0, 0.9, 0.3])
def test_images_of_a_few_px(shape, scale):
    image = np.full(shape, 33, np.uint8)
    window = cut_window(image, -2.5, -1.5, 12, 9, (scale, scale))
    np.testing.assert_array_equal(window.pixels, 33)


@pytest.mark.parametrize("cell", [1, 2, 4])
def test_places_in_cells(cell):
    window = cut_window(np.zeros((60, 80), np.uint8), 11.5, 7.5, 20, 20, (0.5, 0.8))
    cells = window.in_cells(cell)
    points = np.array([[20.0, 30.0], [11.5, 7.5]])
    np.testing.assert_allclose(cells.to_window(points) * cell, window.to_window(points))
    np.testing.assert_allclose(cells.to_image(cells.to_window(points)), points)
    assert cells.pixels is window.pixels
