# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box, HierarchicalEnsembleTracker, State, TrackerConfig
from het_ros.tracking.colour import ColourModel
from het_ros.tracking.colour_search import ColourSearch, miniature
from het_ros.tracking.gray import bgr_of

RED, GREEN = (30, 30, 220), (60, 160, 60)
BOX = Box(60.0, 60.0, 20.0, 40.0)
REACH = np.array([20.0, 30.0])


def image(*places, size=(240, 320)):
    """A green image with red targets, their corners at these places."""
    pixels = np.full((*size, 3), GREEN, np.uint8)
    for x, y in places:
        pixels[y : y + 40, x : x + 20] = RED
    return pixels


@pytest.fixture
def model():
    colour = ColourModel((20, 40), 0.02)
    colour.learn(image((60, 60)), (60, 60))
    return colour


def look(search, pixels, model):
    return search.next_place(pixels, bgr_of, model, BOX, REACH)


@pytest.mark.parametrize("place", [(250, 150), (0, 0), (300, 200), (65, 60)])
def test_it_looks_where_the_colours_are(place, model):
    found = look(ColourSearch(), image(place), model)
    np.testing.assert_allclose(found, np.add(place, (10, 20)), atol=4)


def test_of_two_alike_the_nearer_comes_first_and_then_the_other(model):
    pixels, search = image((250, 150), (110, 60)), ColourSearch()
    first, second = look(search, pixels, model), look(search, pixels, model)
    np.testing.assert_allclose(first, (120, 80), atol=4)
    np.testing.assert_allclose(second, (260, 170), atol=4)


def test_it_comes_back_to_where_it_looked_long_ago(model):
    pixels, search = image((110, 60)), ColourSearch()
    looks = np.array([look(search, pixels, model) for _ in range(30)])
    there = np.abs(looks - (120, 80)).max(axis=1) < 8
    assert 3 < there.sum() < 25


def test_what_was_forgotten_is_looked_at_again(model):
    pixels, search = image((110, 60), (250, 150)), ColourSearch()
    first = look(search, pixels, model)
    search.forget()
    np.testing.assert_array_equal(look(search, pixels, model), first)


@pytest.mark.parametrize(
    ("size", "side", "longest"),
    [
        ((240, 320), 24.0, 160),
        ((2160, 3840), 24.0, 240),
        ((240, 320), 300.0, 48),
        ((9, 20), 5, 20),
    ],
)
def test_a_miniature_is_small_but_not_too_small(size, side, longest):
    small, scale = miniature(np.zeros((*size, 3), np.uint8), side)
    assert max(small.shape) == longest
    assert scale == pytest.approx(longest / max(size), rel=0.02)


def test_who_left_on_one_side_is_found_again_on_the_other():
    """Without the colours a search of the whole image takes as long as it is large."""
    rng = np.random.default_rng(0)
    street = rng.integers(0, 120, (240, 640, 3), np.uint8)
    figure = rng.integers(100, 256, (40, 20, 3), np.uint8)
    figure[..., 0] //= 4

    def seen(x):
        pixels = street.copy()
        if x is not None:
            pixels[100:140, x : x + 20] = figure
        return pixels

    def frames_until_back(**parts):
        tracker = HierarchicalEnsembleTracker(TrackerConfig(**parts))
        tracker.init(seen(40), Box(40.0, 100.0, 20.0, 40.0))
        for x in [*range(42, 60, 2), *[None] * 10]:
            tracker.update(seen(x), 1 / 30)
        assert tracker.state is not State.TRACKING
        for k in range(60):
            estimate = tracker.update(seen(580), 1 / 30)
            if estimate.state is State.TRACKING and estimate.box.x > 500:
                return k
        return 60

    assert frames_until_back() < 20
    assert frames_until_back(colour_search=False) == 60
