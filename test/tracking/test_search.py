# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.search import by_colour, other_size, search_centre

PREDICTED, SEEN, REACH = np.array([50.0, 40.0]), np.array([10.0, 20.0]), np.array([8.0, 6.0])


@pytest.mark.parametrize("hidden", [0, 2, 4, 100])
def test_every_other_frame_at_the_prediction(hidden):
    np.testing.assert_array_equal(search_centre(hidden, PREDICTED, SEEN, REACH), PREDICTED)


def test_first_where_it_was_last_seen():
    np.testing.assert_array_equal(search_centre(1, PREDICTED, SEEN, REACH), SEEN)


def test_two_of_three_looks_away_from_the_prediction_are_where_the_colours_are():
    away = [hidden for hidden in range(600) if hidden % 2]
    assert not any(by_colour(hidden) for hidden in range(0, 600, 2))
    assert sum(by_colour(hidden) for hidden in away) == len(away) * 2 / 3
    assert not by_colour(1)  # at first where it was last seen


def test_farther_and_farther_and_then_again():
    places = [search_centre(k, PREDICTED, SEEN, REACH) for k in range(1, 400, 2)]
    distances = [np.abs((place - SEEN) / REACH).max() for place in places]
    assert max(distances[:3]) == 1
    assert max(distances) == 3
    assert distances.count(0) > 5


@pytest.mark.parametrize("hidden_for", [0.0, 0.1, 0.5])
def test_who_is_just_gone_is_looked_for_at_one_size(hidden_for):
    assert other_size(7, hidden_for) is None


def test_every_place_is_looked_at_at_every_other_size():
    """The second look of a frame is where the first one of the next frame is."""
    looks = {
        (other_size(hidden, 1.0), tuple(search_centre(hidden + 1, PREDICTED, SEEN, REACH)))
        for hidden in range(600)
        if not by_colour(hidden + 1)
    }
    sizes, places = ({look[k] for look in looks} for k in (0, 1))
    assert min(sizes) < 0.75 < 1.4 < max(sizes)
    assert 1.0 not in sizes
    assert len(looks) == len(sizes) * len(places)
