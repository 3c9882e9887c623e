# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.flow import Sight, trace
from het_ros.tracking.gray import gray_of
from het_ros.tracking.window import cut_window

SIZE = (120, 140)  # (w, h) of the windows, px
BOX = Box(140.0, 110.0, 40.0, 60.0)


def picture(seed=0):
    noise = np.random.default_rng(seed).integers(0, 256, (300, 360, 3), dtype=np.uint8)
    return cv2.GaussianBlur(noise, (0, 0), 2)


def shifted(image, dx, dy):
    matrix = np.array([[1, 0, dx], [0, 1, dy]], np.float32)
    return cv2.warpAffine(image, matrix, image.shape[1::-1], borderMode=cv2.BORDER_REFLECT)


def window_at(image, x, y, scale=1.0):
    return cut_window(image, x, y, *SIZE, (scale, scale))


def sight(image, scale=1.0, x=100.0, y=70.0):
    window = window_at(image, x, y, scale)
    return Sight(window, gray_of(window.pixels), BOX)


@pytest.mark.parametrize(
    ("shift", "expected", "corner", "scale"),
    [
        ((0.0, 0.0), (0.0, 0.0), (100.0, 70.0), 1.0),
        ((3.4, -2.2), (0.0, 0.0), (100.0, 70.0), 1.0),
        ((3.0, 2.0), (3.0, 2.0), (103.0, 72.0), 1.0),
        ((12.0, -9.0), (10.0, -10.0), (112.5, 60.0), 1.0),  # another window, a near guess
        ((4.0, 3.0), (0.0, 0.0), (95.0, 65.0), 0.9),  # and another scale
    ],
)
def test_the_target_goes_where_its_pixels_go(shift, expected, corner, scale):
    image = picture()
    window = window_at(shifted(image, *shift), *corner, scale)
    flow = trace(sight(image), window, gray_of(window.pixels), np.array(expected))
    assert flow is not None
    np.testing.assert_allclose(flow.centre, np.array(BOX.centre) + shift, atol=0.3)
    assert flow.share > 0.9


def test_nothing_agrees_between_two_pictures():
    window = window_at(picture(1), 100.0, 70.0)
    flow = trace(sight(picture()), window, gray_of(window.pixels), np.zeros(2))
    assert flow is None or flow.share < 0.3


def test_half_of_the_target_covered():
    """The points that still see the target say where it is, and fewer agree."""
    image = picture()
    after = shifted(image, 2.0, 1.0)
    after[:, 162:] = picture(2)[:, 162:]
    window = window_at(after, 100.0, 70.0)
    flow = trace(sight(image), window, gray_of(window.pixels), np.zeros(2))
    assert flow is not None
    np.testing.assert_allclose(flow.centre, np.add(BOX.centre, (2.0, 1.0)), atol=0.5)
    assert 0.2 < flow.share < 0.8


def test_a_flat_picture_and_a_gray_one():
    flat = np.full((300, 360), 90, np.uint8)
    window = window_at(flat, 100.0, 70.0)
    flow = trace(sight(flat), window, gray_of(window.pixels), np.zeros(2))
    assert flow is None or np.isfinite(flow.centre).all()
