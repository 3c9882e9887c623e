# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros.tracking.top.ego_motion import EgoMotion, registered, thumbnail

UNKNOWN = np.zeros(2)


@pytest.fixture(scope="module")
def street():
    """A wide picture with detail at every scale, of which a camera sees a part."""
    rng = np.random.default_rng(3)
    layers = [
        cv2.resize(rng.integers(0, 256, (900 // k, 1200 // k), np.uint8), (1200, 900))
        for k in (6, 20, 60)
    ]
    gray = np.mean(layers, axis=0).astype(np.uint8)
    return cv2.merge([gray, gray, gray])


def seen(street, x, y, width=640, height=480):
    return street[y : y + height, x : x + width]


@pytest.mark.parametrize("way", [(0, 0), (5, 0), (-20, 10), (60, -45), (150, 30)])
def test_the_camera_turns_and_the_scene_goes_the_other_way(street, way):
    camera = EgoMotion(seen(street, 200, 150))
    shift = camera.follow(seen(street, 200 - way[0], 150 - way[1]), 0.1)
    assert np.abs(shift - way).max() < 1.5  # a px of the thumbnail is 5 px of the image


def test_gray_and_colour_images_tell_the_same(street):
    ways = []
    for picture in (street, street[..., 1]):
        camera = EgoMotion(seen(picture, 200, 150))
        ways.append(camera.follow(seen(picture, 170, 150), 0.1))
    assert (ways[0] == ways[1]).all()


def test_the_velocity_is_that_of_a_steady_turn(street):
    camera = EgoMotion(seen(street, 0, 150))
    for step in range(1, 16):
        camera.follow(seen(street, 20 * step, 150), 0.1)
    assert camera.velocity == pytest.approx([-200, 0], abs=5)


def test_what_moves_in_front_does_not_move_the_scene(street):
    before, now = seen(street, 200, 150).copy(), seen(street, 230, 150).copy()
    for image, x in ((before, 100), (now, 220)):
        image[100:380, x : x + 130] = (20, 200, 90)
    assert EgoMotion(before).follow(now, 0.1) == pytest.approx([-30, 0], abs=1.5)


@pytest.mark.parametrize("expected", [(0.0, 0.0), (9.0, -4.0)])
def test_where_the_picture_tells_nothing_it_fits_as_well_as_anything(expected):
    """Frames of noise share nothing: what is found by chance is not believed."""
    rng = np.random.default_rng(0)
    before, now = (rng.integers(0, 256, (96, 128), np.uint8) for _ in range(2))
    way = registered(before, now, np.array(expected))
    assert tuple(way) in {expected, (0.0, 0.0)}


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((480, 640), (240, 320)),  # another size
        ((480, 640), (640, 480)),
        ((8, 640), (8, 640)),  # too narrow to be registered
        ((1, 1), (1, 1)),
        ((1, 5000), (1, 5000)),
    ],
)
def test_what_cannot_be_compared_stands_still(first, second):
    rng = np.random.default_rng(1)
    camera = EgoMotion(rng.integers(0, 256, (*first, 3), np.uint8))
    shift = camera.follow(rng.integers(0, 256, (*second, 3), np.uint8), 0.1)
    assert (shift == UNKNOWN).all()


@pytest.mark.parametrize("value", [0, 128, 255])
def test_pictures_without_detail_stand_still(value):
    image = np.full((480, 640, 3), value, np.uint8)
    assert EgoMotion(image).follow(image, 0.1) == pytest.approx([0, 0], abs=1e-3)


@pytest.mark.parametrize(
    ("shape", "small"),
    [((480, 640), (96, 128)), ((2160, 3840), (72, 128)), ((100, 50), (100, 50)), ((1, 1), (1, 1))],
)
def test_thumbnails_have_one_size_for_all_large_images(shape, small):
    assert thumbnail(np.zeros(shape, np.uint8)).shape == small


def test_images_are_only_read(street):
    image = seen(street, 200, 150).copy()
    image.setflags(write=False)
    camera = EgoMotion(image)
    assert camera.follow(image, 0.1) == pytest.approx([0, 0], abs=1e-3)


@pytest.mark.parametrize("name", ["Human7", "Couple"])
def test_shaken_real_footage_is_predicted_better_in_the_scene(sequence, name):
    """Two cameras in somebody's hands: the target's way, less the scene's, is much steadier."""
    footage = sequence(name)
    camera, ways, shifts = EgoMotion(footage.image(0)), [], []
    for index in range(1, 100):
        shifts.append(camera.follow(footage.image(index), 1 / 30))
        before, now = footage.boxes[index - 1], footage.boxes[index]
        ways.append(np.subtract(now.centre, before.centre))
    in_image, in_scene = (np.diff(w, axis=0) for w in (ways, np.subtract(ways, shifts)))
    assert in_scene.std() < 0.5 * in_image.std()
