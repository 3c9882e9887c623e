# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a hidden target is looked for, frame by frame."""

import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.top.redetection import Redetection

PREDICTED, LAST, REACH = np.array([150.0, 140.0]), Box(90, 105, 20, 30), np.array([28.0, 36.0])
IMAGE = np.zeros((240, 320, 3), np.uint8)


def places(hidden, likelihood=None, candidates=(), image=IMAGE):
    search = Redetection()
    return [
        search.next_place(k, PREDICTED, LAST, REACH, image, likelihood, candidates) for k in hidden
    ]


def redness(pixels):
    return pixels[..., 2].astype(np.float32) / 255


def red_at(*boxes):
    image = IMAGE.copy()
    for x, y in boxes:
        image[y : y + 30, x : x + 20] = (0, 0, 255)
    return image


@pytest.mark.parametrize("likelihood", [None, redness])
def test_every_second_look_is_at_the_prediction(likelihood):
    for place in places(range(0, 100, 2), likelihood, (Box(1, 1, 5, 5),)):
        np.testing.assert_array_equal(place, PREDICTED)


def test_without_colours_it_goes_farther_and_farther_and_then_again():
    found = [(place - LAST.centre) / REACH for place in places(range(1, 600, 2))]
    rings = [int(np.abs(step).max()) for step in found]
    assert rings[0] == 0
    assert rings[:4] == sorted(rings[:4])
    assert max(rings) == 3
    assert {tuple(step) for step in found} == {(x, y) for x in range(-3, 4) for y in range(-3, 4)}
    assert rings.count(0) > 1


def test_two_of_three_looks_away_from_the_prediction_go_by_colour():
    asked = []

    def likelihood(pixels):
        asked.append(pixels.shape)
        return redness(pixels)

    places(range(60), likelihood)
    assert len(asked) == 20


@pytest.mark.parametrize("place", [(30, 40), (250, 180), (0, 0), (300, 205)], ids=str)
def test_it_looks_where_the_targets_colours_are(place):
    found = places([3], redness, image=red_at(place))[0]
    np.testing.assert_allclose(found, np.add(place, (10, 15)), atol=4)


def test_of_two_such_places_the_nearer_one_first_and_then_the_other():
    """A place that was just looked at in vain counts less."""
    near, far = (130, 110), (280, 20)
    looks = places([3, 5], redness, image=red_at(near, far))
    for place, look in zip((near, far), looks, strict=True):
        np.testing.assert_allclose(look, np.add(place, (10, 15)), atol=4)


def test_what_was_looked_at_is_forgotten_once_the_target_is_there():
    search, image = Redetection(), red_at((130, 110), (280, 20))
    looks = []
    for forget in (False, True):
        if forget:
            search.forget()
        looks.append(search.next_place(3, PREDICTED, LAST, REACH, image, redness))
    np.testing.assert_array_equal(*looks)


def test_candidates_come_before_colours_the_nearest_first_and_in_turns():
    boxes = (Box(10, 10, 20, 30), Box(160, 150, 20, 30))
    found = places([1, 3, 5, 7], redness, boxes, red_at((280, 20)))
    # The turn is the number of looks away from the prediction.
    nearest_first = [boxes[1].centre, boxes[0].centre]
    assert [tuple(place) for place in found] == [nearest_first[turn % 2] for turn in range(4)]


@pytest.mark.parametrize("shape", [(1, 1, 3), (1, 900, 3), (2000, 3000, 3)], ids=str)
def test_images_of_any_size_are_searched(shape):
    image = np.zeros(shape, np.uint8)
    place = places([3], redness, image=image)[0]
    assert ((place >= 0) & (place < np.array(shape[1::-1]) + 10)).all()


def test_large_images_are_searched_reduced():
    seen = []

    def likelihood(pixels):
        seen.append(pixels.shape)
        return redness(pixels)

    places([3], likelihood, image=np.zeros((2160, 3840, 3), np.uint8))
    assert max(seen[0]) <= 240
