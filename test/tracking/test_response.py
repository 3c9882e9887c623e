# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.response import find_peak, vote

OFFSETS = np.array([[0, 0], [3, 1], [2, 5], [1, 2]])
PLACES = (14, 17)
SHAPE = (len(OFFSETS), PLACES[0] + 5, PLACES[1] + 3)
NO_COLOUR = np.zeros(PLACES, np.float32)


def scores(seed=0):
    return np.random.default_rng(seed).normal(size=SHAPE)


def slow_vote(scores, offsets, shape):
    """Each place of the target asks each sub-patch about its own place there."""
    total = np.empty(shape)
    for y in range(shape[0]):
        for x in range(shape[1]):
            total[y, x] = np.mean(
                [one[y + dy, x + dx] for one, (dx, dy) in zip(scores, offsets, strict=True)]
            )
    return total


def bump(at, sigma=2.0, height=1.0):
    """Scores whose sub-patches all find a target with its corner at ``at``."""
    made = np.empty(SHAPE)
    rows, columns = np.mgrid[: SHAPE[1], : SHAPE[2]]
    for q, (dx, dy) in enumerate(OFFSETS):
        far = (columns - at[0] - dx) ** 2 + (rows - at[1] - dy) ** 2
        made[q] = height * np.exp(-0.5 * far / sigma**2)
    return made


def test_vote():
    np.testing.assert_allclose(
        vote(scores(), OFFSETS, PLACES), slow_vote(scores(), OFFSETS, PLACES)
    )


def test_vote_leaves_the_scores_as_they_are():
    given = scores()
    vote(given, OFFSETS, PLACES)
    np.testing.assert_array_equal(given, scores())


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_find_peak_against_loops(seed, share):
    given, colour = scores(seed), np.random.default_rng(seed + 50).random(PLACES)
    apart = (3, 2)
    peak = find_peak(given, OFFSETS, colour, share, apart)
    template = slow_vote(given, OFFSETS, PLACES)
    best, rival = (-np.inf, 0, 0), -np.inf
    for y in range(PLACES[0]):
        for x in range(PLACES[1]):
            best = max(best, ((1 - share) * template[y, x] + share * colour[y, x], x, y))
    _, x, y = best
    for v in range(PLACES[0]):
        for u in range(PLACES[1]):
            if abs(u - x) > apart[0] or abs(v - y) > apart[1]:
                rival = max(rival, template[v, u])
    np.testing.assert_allclose(peak.corner, [x, y], atol=0.5)
    assert peak.template == pytest.approx(template[y, x])
    assert peak.colour == pytest.approx(colour[y, x])
    assert peak.rival == pytest.approx(rival)
    wanted = [one[y + dy, x + dx] for one, (dx, dy) in zip(given, OFFSETS, strict=True)]
    np.testing.assert_allclose(peak.patch_scores, wanted)


@pytest.mark.parametrize("at", [(7.0, 6.0), (7.3, 5.6), (4.5, 8.25), (11.9, 3.1)], ids=str)
def test_a_smooth_peak_is_found_between_the_places(at):
    peak = find_peak(bump(at), OFFSETS, NO_COLOUR, 0.0, (4, 4))
    np.testing.assert_allclose(peak.corner, at, atol=0.05)


@pytest.mark.parametrize("at", [(0.0, 0.0), (16.0, 13.0), (0.0, 13.0)], ids=str)
def test_a_peak_at_the_maps_edge(at):
    peak = find_peak(bump(at), OFFSETS, NO_COLOUR, 0.0, (4, 4))
    np.testing.assert_array_equal(peak.corner, at)


def test_a_second_target_is_the_rival():
    both = np.maximum(bump((3, 3), 1.0), bump((13, 9), 1.0, height=0.8))
    peak = find_peak(both, OFFSETS, NO_COLOUR, 0.0, (4, 4))
    np.testing.assert_allclose(peak.corner, (3, 3), atol=0.1)
    assert peak.rival == pytest.approx(0.8, abs=0.02)
    alone = find_peak(bump((3, 3), 1.0), OFFSETS, NO_COLOUR, 0.0, (4, 4))
    assert alone.rival < 0.05


def test_most_sub_patches_win_over_one_that_shouts():
    given = bump((3, 3))
    given[0] = 0
    given[0, 10, 12] = 1.9  # one alone, nearly twice as sure
    np.testing.assert_allclose(
        find_peak(given, OFFSETS, NO_COLOUR, 0.0, (3, 3)).corner, (3, 3), atol=0.1
    )


def test_colours_decide_between_equals():
    both = np.maximum(bump((3, 3), 1.0), bump((13, 9), 1.0))
    colour = np.full(PLACES, 0.2, np.float32)
    colour[8:11, 12:15] = 0.9
    peak = find_peak(both, OFFSETS, colour, 0.4, (4, 4))
    np.testing.assert_allclose(peak.corner, (13, 9), atol=0.1)
    assert peak.colour == pytest.approx(0.9)


def test_where_all_is_near_there_is_no_rival():
    peak = find_peak(scores(), OFFSETS, NO_COLOUR, 0.0, (40, 40))
    assert peak.rival <= 0
