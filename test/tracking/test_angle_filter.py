# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros.tracking.angle_filter import AngleFilter
from het_ros.tracking.window import cut_window

SIZE = (60.0, 60.0)
CENTRE = np.array([100.0, 90.0])


def picture(seed=0):
    noise = np.random.default_rng(seed).integers(0, 256, (180, 200, 3), dtype=np.uint8)
    return cv2.GaussianBlur(noise, (0, 0), 4)


def turned(image, degrees, centre=CENTRE):
    """Turned clockwise around a place given in px corners, as the package counts them."""
    x, y = (centre - 0.5).tolist()
    matrix = cv2.getRotationMatrix2D((x, y), -degrees, 1.0)
    return cv2.warpAffine(image, matrix, image.shape[1::-1], borderMode=cv2.BORDER_REFLECT)


def degrees_found(filter_, image, centre=CENTRE):
    return np.degrees(filter_.turn(filter_.spectrum(image, centre)))


def learnt(image, size=SIZE, centre=CENTRE):
    filter_ = AngleFilter(*size)
    filter_.learn(filter_.spectrum(image, centre), 0.0)
    return filter_


@pytest.mark.parametrize("gray", [False, True], ids=["colour", "gray"])
@pytest.mark.parametrize("degrees", [-20, -9, -3, 0, 2, 6, 14, 21])
def test_a_turn_is_found_with_its_sign(degrees, gray):
    image = picture()
    if gray:
        image = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    assert degrees_found(learnt(image), turned(image, degrees)) == pytest.approx(degrees, abs=2)


@pytest.mark.parametrize("degrees", [-12, -5, 5, 12])
@pytest.mark.parametrize("name", ["David", "Crossing", "Couple", "Car1", "MotorRolling"])
def test_a_turn_of_a_real_frame_is_found(sequence, name, degrees):
    """The whole image turns, as where the camera rolls; a cell's 5.6 degrees are a step."""
    frames = sequence(name)
    image, box = frames.image(0), frames.boxes[0]
    scale = 48 / np.sqrt(box.area)
    x, y = np.array(box.centre) - 80 / scale
    image = cut_window(image, float(x), float(y), 160, 160, (scale, scale)).pixels
    size, centre = (scale * box.w, scale * box.h), np.array([80.0, 80.0])
    found = degrees_found(learnt(image, size, centre), turned(image, degrees, centre), centre)
    assert found == pytest.approx(degrees, abs=3)


def test_what_is_learnt_as_turned_is_straight_when_turned_back():
    image, filter_ = picture(), AngleFilter(*SIZE)
    filter_.learn(filter_.spectrum(turned(image, 30), CENTRE), np.radians(30))
    assert degrees_found(filter_, image) == pytest.approx(0, abs=2)


def test_angles_go_all_the_way_round():
    """Learnt nearly half a turn round, a bit more is still a bit more."""
    image, filter_ = picture(), AngleFilter(*SIZE)
    filter_.learn(filter_.spectrum(turned(image, 175), CENTRE), 0.0)
    assert degrees_found(filter_, turned(image, 185)) == pytest.approx(10, abs=2)


def test_surroundings_that_turn_alone_turn_nothing():
    """A narrow target stands still in the middle of a picture that turns around it."""
    image, moved = picture(), turned(picture(), 14)
    width, height = 24, 100
    left, top = (CENTRE - (width / 2, height / 2)).astype(int)
    target = np.s_[top : top + height, left : left + width]
    moved[target] = image[target]
    assert abs(degrees_found(learnt(image, (width, height)), moved)) < 4


def test_flat_pictures_turn_nowhere():
    flat = np.full((180, 200, 3), 90, np.uint8)
    assert degrees_found(learnt(flat), flat) == 0


def test_new_appearances_are_learnt():
    first, second = picture(0), picture(1)
    filter_ = learnt(first)
    for _ in range(200):
        filter_.learn(filter_.spectrum(second, CENTRE), 0.0)
    assert degrees_found(filter_, turned(second, 8)) == pytest.approx(8, abs=2)


def test_nothing_learnt_is_an_error():
    filter_ = AngleFilter(*SIZE)
    with pytest.raises(RuntimeError, match="call learn first"):
        filter_.turn(filter_.spectrum(picture(), CENTRE))


@pytest.mark.parametrize("size", [(1.0, 1.0), (8.0, 400.0), (2000.0, 30.0)])
def test_targets_of_any_shape_at_the_border(size):
    found = degrees_found(learnt(picture(), size, np.zeros(2)), picture(), np.zeros(2))
    assert found == pytest.approx(0, abs=1)
