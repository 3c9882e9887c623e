# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.bottom.sub_patches import Layout, SubPatchEnsembles, draw_layout

from .looks import look_at

LAYOUT = Layout((12, 20), np.array([[0, 0], [8, 3], [5, 10], [2, 7]]))
CELLS, WINDOW = (20, 30), (60, 80)
MAPS = (WINDOW[1] - 19, WINDOW[0] - 11)
IMAGE = np.zeros((80, 60, 3), np.uint8)


def seen(features):
    places = LAYOUT.places(features.shape[1:], CELLS)
    return look_at(IMAGE, (0.0, 0.0), WINDOW, features=features, places=places)


def maps(seed):
    return np.random.default_rng(seed).normal(size=(6, *MAPS)).astype(np.float32)


def ensembles():
    return SubPatchEnsembles(LAYOUT, CELLS, (0.02, 0.05), 0.01, 0.1)


@pytest.mark.parametrize("target", [(24, 24), (14, 41), (4, 9), (1, 1)], ids=str)
@pytest.mark.parametrize("fraction", [0.1, 0.75, 1.0])
def test_sub_patches_lie_inside_their_target(target, fraction):
    layout = draw_layout(target, 40, fraction, np.random.default_rng(0))
    assert layout.offsets.shape == (40, 2)
    assert (layout.offsets >= 0).all()
    assert (layout.offsets + layout.size <= np.maximum(target, layout.size)).all()
    for side, wanted in zip(layout.size, target, strict=True):
        assert side == max(1, round(fraction * wanted))


def test_offsets_reach_every_place_and_follow_the_seed():
    drawn = [draw_layout((24, 24), 900, 0.75, np.random.default_rng(s)).offsets for s in (1, 1, 2)]
    np.testing.assert_array_equal(drawn[0], drawn[1])
    assert not np.array_equal(drawn[0], drawn[2])
    assert {tuple(offset) for offset in drawn[0].tolist()} == set(np.ndindex(7, 7))


def test_there_are_as_many_places_as_every_sub_patch_has_room_for():
    layout = draw_layout(CELLS, 200, 0.6, np.random.default_rng(0))
    maps = WINDOW[1] - layout.size[1] + 1, WINDOW[0] - layout.size[0] + 1
    rows, columns = layout.places(maps, CELLS)
    assert (rows, columns) == (WINDOW[1] - CELLS[1] + 1, WINDOW[0] - CELLS[0] + 1)
    x, y = layout.offsets.max(axis=0)
    assert (rows + y, columns + x) == maps


def test_votes_against_loops():
    """Each place of the target asks each sub-patch about its own place there."""
    model = ensembles()
    model.learn(seen(maps(0)), Box(20, 25, *CELLS), 1.0)
    look = seen(maps(1))
    votes = model.vote(look)
    assert votes.shape == look.places
    for y in range(look.places[0]):
        for x in range(look.places[1]):
            scores = [
                one[y + dy, x + dx]
                for one, (dx, dy) in zip(model.scores, LAYOUT.offsets.tolist(), strict=True)
            ]
            assert votes[y, x] == pytest.approx(np.mean(scores), abs=1e-5)
            np.testing.assert_array_equal(model.scores_at(y, x), scores)


def marked(*corners):
    """Features of which each marks the place of one sub-patch of a target at (x, y)."""
    features = maps(0) / 20
    rows, columns = np.mgrid[: MAPS[0], : MAPS[1]]
    for (x, y), marks in corners:
        for q in marks:
            dx, dy = LAYOUT.offsets[q]
            far = (columns - x - dx) ** 2 + (rows - y - dy) ** 2
            features[q] += 3 * np.exp(-0.5 * far / 3**2).astype(np.float32)
    return features


ALL = range(len(LAYOUT.offsets))


@pytest.mark.parametrize("place", [(20, 25), (17, 29), (0, 0), (40, 50)], ids=str)
def test_the_target_is_found_where_its_features_went(place):
    model = ensembles()
    model.learn(seen(marked(((20, 25), ALL))), Box(20, 25, *CELLS), 1.0)
    votes = model.vote(seen(marked((place, ALL))))
    row, column = divmod(int(votes.argmax()), votes.shape[1])
    np.testing.assert_allclose((column, row), place, atol=1)


def test_most_sub_patches_win_over_one():
    """One of four is sure of another place and outvoted; the mean score says how many agree."""
    model = ensembles()
    model.learn(seen(marked(((20, 25), ALL))), Box(20, 25, *CELLS), 1.0)
    whole = model.vote(seen(marked(((20, 25), ALL)))).max()
    votes = model.vote(seen(marked(((5, 5), [0]), ((20, 25), [1, 2, 3]))))
    row, column = divmod(int(votes.argmax()), votes.shape[1])
    np.testing.assert_allclose((column, row), (20, 25), atol=1)
    assert votes.max() < 0.9 * whole
    assert model.scores_at(row, column)[0] < 0.5 * model.scores_at(row, column)[1:].min()


def test_what_is_followed_but_not_learnt_changes_nothing():
    model, look = ensembles(), seen(maps(1))
    model.learn(seen(maps(0)), Box(20, 25, *CELLS), 1.0)
    before = model.vote(look)
    model.learn(look, Box(3, 3, *CELLS), 0.0)
    model.forget()
    np.testing.assert_array_equal(model.vote(look), before)
