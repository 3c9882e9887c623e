# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.flow import Sight, trace, without_background
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


@pytest.mark.parametrize("camera", [(0.0, 0.0), (-3.0, 1.0)])
def test_background_in_the_box_is_not_followed(camera):
    """A target that fills two fifths of its box goes its own way over the background."""
    image, target = picture(), picture(3)[:, :16]
    moved, after = (5.0, -3.0), shifted(image, *camera)
    image[100:180, 154:170] = target[100:180]
    after[100 - 3 : 180 - 3, 154 + 5 : 170 + 5] = target[100:180]
    window = window_at(after, 100.0, 70.0)
    flow = trace(sight(image), window, gray_of(window.pixels), np.zeros(2))
    assert flow is not None
    np.testing.assert_allclose(flow.centre, np.add(BOX.centre, moved), atol=0.5)


STILL, AWAY = np.zeros((24, 2), np.float32), np.full((60, 2), 4.0, np.float32)
APART = np.stack([np.linspace(-30, 30, 60), np.full(60, 9.0)], axis=1).astype(np.float32)


@pytest.mark.parametrize(
    ("own", "around", "left"),
    [
        (AWAY, STILL, 60),  # what goes another way is the target
        (AWAY[:25], STILL, 25),
        (AWAY[:10], STILL, 10 + 40),  # an arm
        (APART, STILL, 60 + 40),  # they do not go together
        (AWAY, STILL[:5], 60 + 40),  # nothing is known of the background
        (AWAY, np.concatenate([STILL[:12] - 9, STILL[:12] + 9]), 60 + 40),  # nor here
    ],
)
def test_whose_ways_are_the_targets(own, around, left):
    with_background = np.concatenate([own, np.zeros((40, 2), np.float32)])
    assert len(without_background(with_background, around, 40.0)) == left


def test_who_stands_still_with_everything_keeps_all_points():
    assert len(without_background(np.zeros((100, 2), np.float32), STILL, 40.0)) == 100
