# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from features.slow import replicated_window
from het_ros.tracking.features.window import cut_window

IMAGE = np.arange(12 * 17, dtype=np.uint8).reshape(12, 17)


@pytest.mark.parametrize(
    ("x", "y", "width", "height"),
    [
        (3, 2, 5, 6),
        (-4, 2, 9, 5),  # over the left border
        (12, 8, 9, 9),  # over the lower right corner
        (-3, -3, 30, 30),  # the whole image and more
        (40, 3, 6, 6),  # wholly outside, on each side
        (-40, 3, 6, 6),
        (3, 90, 6, 6),
        (3, -90, 6, 6),
        (5.7, 2.9, 4, 4),  # starts on the px before it
        (-0.3, -0.3, 1, 1),
    ],
)
@pytest.mark.parametrize("image", [IMAGE, np.dstack([IMAGE] * 3)], ids=["gray", "colour"])
def test_border_is_repeated_as_far_as_needed(image, x, y, width, height):
    window = cut_window(image, x, y, width, height)
    left, top = int(np.floor(x)), int(np.floor(y))
    np.testing.assert_array_equal(
        window.pixels, replicated_window(image, left, top, width, height)
    )
    assert window.origin == (left, top)
    assert window.scale == (1, 1)


def test_window_inside_the_image_copies_nothing():
    assert np.shares_memory(cut_window(IMAGE, 3, 2, 5, 6).pixels, IMAGE)


@pytest.mark.parametrize("scale", [0.25, 0.37, 1.0, 2.5])
def test_points_there_and_back(scale):
    image = np.zeros((200, 300), np.uint8)
    window = cut_window(image, 51.2, 60.7, 40, 24, (scale, scale))
    assert window.pixels.shape == (24, 40)
    assert window.scale == (scale, scale)
    points = np.array([[51.0, 60.0], [80.5, 77.25], [-3.0, 400.0]])
    np.testing.assert_allclose(window.to_image(window.to_window(points)), points)
    np.testing.assert_allclose(window.to_window(np.array(window.origin)), [0, 0])


@pytest.mark.parametrize(
    "scale", [(2.5, 1.7), (0.9, 0.8), (0.5, 0.45), (0.21, 0.19), (0.05, 0.06)]
)
@pytest.mark.parametrize("at", [(812.3, 640.8), (1003.0, 590.0)])
def test_a_mark_is_found_where_the_conversion_says(scale, at):
    """A soft mark a few window px wide keeps its place to a fraction of a window px."""
    height, width = 1400, 1800
    spread = 3 / min(scale)
    across = np.exp(-0.5 * ((np.arange(width) + 0.5 - at[0]) / spread) ** 2)
    down = np.exp(-0.5 * ((np.arange(height) + 0.5 - at[1]) / spread) ** 2)
    image = np.rint(250 * np.outer(down, across)).astype(np.uint8)
    half = 15.0 / np.array(scale)
    window = cut_window(image, at[0] - half[0] + 0.4, at[1] - half[1] - 0.7, 30, 30, scale)
    rows, columns = np.mgrid[:30, :30] + 0.5
    mass = window.pixels.astype(float)
    found = np.array([(columns * mass).sum(), (rows * mass).sum()]) / mass.sum()
    error = (window.to_image(found) - at) * scale
    np.testing.assert_allclose(error, 0, atol=0.15)
