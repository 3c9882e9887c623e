import numpy as np
import pytest
from reference import replicated_window

from het_ros.tracking.window import cut_window

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
    window = cut_window(image, 51.2, 60.7, 40, 24, scale)
    assert window.pixels.shape == (24, 40)
    assert window.scale == pytest.approx((scale, scale), rel=0.1)
    points = np.array([[51.0, 60.0], [80.5, 77.25], [-3.0, 400.0]])
    np.testing.assert_allclose(window.to_image(window.to_window(points)), points)
    np.testing.assert_allclose(window.to_window(np.array(window.origin)), [0, 0])


def test_a_mark_is_found_where_the_conversion_says():
    image = np.zeros((200, 300), np.uint8)
    image[100:108, 160:168] = 255
    window = cut_window(image, 120, 60, 30, 30, scale=0.25)
    y, x = np.argwhere(window.pixels == 255).mean(axis=0) + 0.5
    np.testing.assert_allclose(window.to_image(np.array([x, y])), [164, 104])
