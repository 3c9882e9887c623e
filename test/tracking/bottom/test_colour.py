# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from collections import Counter

import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.bottom.colour import ColourEnsemble, box_means, cell_means, colour_bins

from .looks import look_at

RNG = np.random.default_rng(3)
FEW = RNG.integers(0, 3, (40, 50, 3), np.uint8) * 90  # 27 colours, so that bins repeat
GRAY = RNG.integers(0, 3, (40, 50), np.uint8) * 25
CORNER, SIZE = (14.0, 9.0), (20, 15)
EMPTY, STRANGE = 1e-4, 0.2


def layers(pixels):
    """Colours as they are; of gray values the level and 4 times the deviation in 7 x 7 px."""
    if pixels.ndim == 3:
        return pixels
    wide = np.pad(pixels.astype(float), 3, mode="reflect")
    rows, columns = pixels.shape
    differ = [[wide[y : y + 7, x : x + 7].std() for x in range(columns)] for y in range(rows)]
    return np.dstack([pixels, np.rint(4 * np.array(differ)).clip(0, 255)])


def slow_bin(pixel):
    """16 levels a channel, the first channel highest."""
    number = 0
    for value in np.atleast_1d(pixel):
        number = 16 * number + int(value) // 16
    return number


def slow_range(start, length, more, limit):
    first = min(max(round(start - more), 0), limit - 1)
    return range(first, min(max(round(start + length + more), first + 1), limit))


def slow_counts(pixels, inside, outside=None):
    """Share of each colour over the px of one box that are not in another."""
    counts = Counter()
    for y in inside[1]:
        for x in inside[0]:
            if outside is None or x not in outside[0] or y not in outside[1]:
                counts[slow_bin(pixels[y, x])] += 1
    total = sum(counts.values())
    return {colour: count / total for colour, count in counts.items()}


def slow_histograms(pixels, corner, size):
    """The target's from the middle 80 % of its box; the surroundings' from a ring around it."""
    limits = pixels.shape[1::-1]

    def box(*margins):
        return [slow_range(*side) for side in zip(corner, size, margins, limits, strict=True)]

    ring = round(0.3 * (size[0] + size[1]) / 2)
    return (
        slow_counts(pixels, box(-0.1 * size[0], -0.1 * size[1])),
        slow_counts(pixels, box(ring, ring), box(2, 2)),
    )


def slow_likelihood(pixels, target, around):
    result = np.empty(pixels.shape[:2])
    for y in range(pixels.shape[0]):
        for x in range(pixels.shape[1]):
            colour = slow_bin(pixels[y, x])
            its, theirs = target.get(colour, 0) + EMPTY, around.get(colour, 0)
            result[y, x] = its / (its + theirs + EMPTY / STRANGE - EMPTY)
    return result


def blended(old, new, rate):
    return {c: (1 - rate) * old.get(c, 0) + rate * new.get(c, 0) for c in {*old, *new}}


@pytest.mark.parametrize("pixels", [FEW, GRAY], ids=["colour", "gray"])
def test_bins(pixels):
    bins, told = colour_bins(pixels), layers(pixels)
    assert bins.shape == pixels.shape[:2]
    for y in range(0, 40, 7):
        for x in range(0, 50, 7):
            assert bins[y, x] == slow_bin(told[y, x]) < 4096


@pytest.mark.parametrize("pixels", [FEW, GRAY], ids=["colour", "gray"])
@pytest.mark.parametrize(
    "corner", [CORNER, (14.4, 8.7), (-6.0, -3.0), (41.0, 33.0)], ids=str
)  # the last two reach over the border
def test_likelihood_of_one_frame(pixels, corner):
    model = ColourEnsemble(SIZE, 1, 0.3)
    model.learn_pixels(pixels, corner, 1.0)
    told = layers(pixels)
    wanted = slow_likelihood(told, *slow_histograms(told, corner, SIZE))
    found = model.likelihood(pixels)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, wanted, atol=1e-5)


def test_later_frames_are_blended_in():
    later = np.roll(FEW, 5, axis=1)[::-1].copy()
    model = ColourEnsemble(SIZE, 1, 0.3)
    model.learn_pixels(FEW, CORNER, 1.0)
    model.learn_pixels(later, (16.0, 11.0), 1.0)
    old, new = slow_histograms(FEW, CORNER, SIZE), slow_histograms(later, (16.0, 11.0), SIZE)
    wanted = slow_likelihood(FEW, *(blended(a, b, 0.3) for a, b in zip(old, new, strict=True)))
    np.testing.assert_allclose(model.likelihood(FEW), wanted, atol=1e-5)


@pytest.mark.parametrize("weight", [0.0, 0.4])
def test_a_frame_counts_by_its_weight(weight):
    later = np.roll(FEW, 5, axis=1)
    model, slower = ColourEnsemble(SIZE, 1, 0.3), ColourEnsemble(SIZE, 1, 0.3 * weight)
    for each, share in ((model, weight), (slower, 1.0)):
        each.learn_pixels(FEW, CORNER, 1.0)
        each.learn_pixels(later, CORNER, share)
    np.testing.assert_allclose(model.likelihood(FEW), slower.likelihood(FEW), rtol=1e-6)


@pytest.mark.parametrize("cell", [1, 2])
def test_it_votes_for_the_place_of_the_targets_colours(cell):
    """A red box on green, learnt at one place and looked for at another."""
    green, red = (0, 200, 0), (0, 0, 200)
    first, second = (np.full((200, 220, 3), green, np.uint8) for _ in range(2))
    first[60:90, 70:90] = red
    second[72:102, 64:84] = red
    model = ColourEnsemble((20 * cell, 30 * cell), cell, 0.02)
    window = {"corner": (40.0, 40.0), "shape": (80 * cell, 90 * cell), "scale": float(cell)}
    model.learn(look_at(first, **window, cell=cell), Box(70, 60, 20, 30), 1.0)
    look = look_at(second, **window, cell=cell)
    votes = model.vote(look)
    assert votes.shape == look.places
    row, column = divmod(int(votes.argmax()), votes.shape[1])
    np.testing.assert_allclose((column, row), (24, 32), atol=1)
    assert votes.max() > 0.9
    model.learn(look, Box(0, 0, 20, 30), 0.0)  # followed, not learnt
    np.testing.assert_array_equal(model.vote(look), votes)


def test_what_the_likelihood_says():
    red, green, blue = (0, 0, 200), (0, 200, 0), (200, 0, 0)
    image = np.full((60, 60, 3), green, np.uint8)
    image[20:40, 25:35] = red
    model = ColourEnsemble((10, 20), 1, 0.02)
    model.learn_pixels(image, (25.0, 20.0), 1.0)
    others = np.array([[red, green, blue]], np.uint8)
    its, surroundings, unknown = model.likelihood(others)[0]
    assert its > 0.99
    assert surroundings < 0.01
    assert unknown == pytest.approx(STRANGE)


def slow_coefficient(there, target, around):
    """Of two histograms; colours count by how much they are the target's."""
    own = {
        colour: (share + EMPTY) / (share + around.get(colour, 0) + EMPTY / STRANGE)
        for colour, share in target.items()
    }
    both = sum(own[colour] * (target[colour] * there.get(colour, 0)) ** 0.5 for colour in target)
    return both / sum(own[colour] * target[colour] for colour in target)


@pytest.mark.parametrize("pixels", [FEW, GRAY], ids=["colour", "gray"])
def test_similarity_is_that_of_the_histograms_over_what_is_usual(pixels):
    """Learnt at one place and from a second frame; asked for at a third."""
    later = np.roll(pixels, 5, axis=1)[::-1].copy()
    model = ColourEnsemble(SIZE, 1, 0.3)
    model.learn_pixels(pixels, CORNER, 1.0)
    model.learn_pixels(later, CORNER, 1.0)
    look = look_at(pixels, (0.0, 0.0), (50, 40), cells=SIZE)
    (first, around), (second, later_around), (there, _) = (
        slow_histograms(layers(image), corner, SIZE)
        for image, corner in ((pixels, CORNER), (later, CORNER), (pixels, (20.0, 12.0)))
    )
    usual = 1 + 0.3 * (slow_coefficient(second, first, around) - 1)
    learnt = blended(first, second, 0.3), blended(around, later_around, 0.3)
    wanted = slow_coefficient(there, *learnt) / usual
    assert model.similarity(look, Box(20, 12, *SIZE)) == pytest.approx(wanted, abs=1e-5)


def test_somebody_in_other_clothes_is_unlike_the_target():
    """Red over blue; the other one is white over blue: neither is like the green around."""
    image = np.full((60, 80, 3), (0, 200, 0), np.uint8)
    image[20:35, 10:20], image[20:35, 50:60] = (0, 0, 200), (250, 250, 250)
    image[35:50, 10:20] = image[35:50, 50:60] = (200, 0, 0)
    model = ColourEnsemble((10, 30), 1, 0.02)
    look = look_at(image, (0.0, 0.0), (80, 60), cells=(10, 30))
    its, others = Box(10, 20, 10, 30), Box(50, 20, 10, 30)
    with pytest.raises(RuntimeError, match="learn"):
        model.similarity(look, its)
    model.learn(look, its, 1.0)
    assert model.similarity(look, its) == pytest.approx(1)
    assert model.similarity(look, others) == pytest.approx(0.5, abs=0.01)
    assert model.similarity(look, Box(30, 20, 10, 30)) == 0


@pytest.mark.parametrize("corner", [(-500.0, 3.0), (3.0, 500.0), (-500.0, -500.0)])
def test_a_target_wholly_outside_the_window_is_survived(corner):
    model = ColourEnsemble(SIZE, 1, 0.02)
    model.learn_pixels(FEW, corner, 1.0)
    found = model.likelihood(FEW)
    assert np.isfinite(found).all()
    assert 0 <= found.min() <= found.max() <= 1


def test_a_target_that_fills_the_window_has_no_surroundings():
    model = ColourEnsemble((50, 40), 1, 0.02)
    model.learn_pixels(FEW, (0.0, 0.0), 1.0)
    assert model.likelihood(FEW).min() > 0.9


def test_likelihood_needs_a_model():
    with pytest.raises(RuntimeError, match="learn first"):
        ColourEnsemble(SIZE, 1, 0.02).likelihood(FEW)


@pytest.mark.parametrize("cell", [1, 2, 3, 7])
def test_cell_means(cell):
    plane = RNG.random((23, 31)).astype(np.float32)
    found = cell_means(plane, cell)
    assert found.shape == (23 // cell, 31 // cell)
    for row in range(found.shape[0]):
        for column in range(found.shape[1]):
            part = plane[row * cell : (row + 1) * cell, column * cell : (column + 1) * cell]
            assert found[row, column] == pytest.approx(part.mean(), abs=1e-5)


@pytest.mark.parametrize("size", [(1, 1), (4, 7), (9, 3), (20, 16)], ids=str)
def test_box_means(size):
    plane = RNG.random((16, 20)).astype(np.float32)
    places = (16 - size[1] + 1, 20 - size[0] + 1)
    found = box_means(plane, size, places)
    assert found.shape == places
    for y in range(places[0]):
        for x in range(places[1]):
            part = plane[y : y + size[1], x : x + size[0]]
            assert found[y, x] == pytest.approx(part.mean(), abs=1e-5)
