# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Cosines against slow loops, and which of them belongs to a place."""

import numpy as np
import pytest

from het_ros.tracking.bottom.resemblance import Resemblance, middle_of


def cosines(template, search):
    """Those of all places, one pixel of the image apart: (n, n)."""
    alike = Resemblance(middle_of(template), search, (0.0, 0.0), 1.0)
    places = np.arange(search.shape[1] - template.shape[1] // 2 + 1)
    places = places - places[-1] / 2
    return np.array([[alike.at((x, y)) for x in places] for y in places])


@pytest.mark.parametrize(("template", "search"), [(8, 16), (4, 9), (2, 5)])
def test_cosines_are_those_of_a_slow_loop(template, search):
    rng = np.random.default_rng(0)
    one = rng.normal(size=(3, template, template)).astype(np.float32)
    other = rng.normal(size=(3, search, search)).astype(np.float32)
    side, first = template // 2, template // 4
    middle = one[:, first : first + side, first : first + side].ravel()
    found = cosines(one, other)
    assert found.shape == (search - side + 1,) * 2
    for row in range(len(found)):
        for column in range(len(found)):
            there = other[:, row : row + side, column : column + side].ravel()
            wanted = middle @ there / np.linalg.norm(middle) / np.linalg.norm(there)
            assert found[row, column] == pytest.approx(wanted, abs=1e-5)


def test_it_is_one_where_the_template_is_and_finite_where_nothing_is():
    rng = np.random.default_rng(0)
    search = np.zeros((3, 16, 16), np.float32)
    template = rng.normal(size=(3, 8, 8)).astype(np.float32)
    search[:, 1:9, 3:11] = template
    found = cosines(template, search)
    assert np.unravel_index(found.argmax(), found.shape) == (3, 5)
    assert found.max() == pytest.approx(1)
    assert np.isfinite(found).all()


@pytest.mark.parametrize(
    ("place", "row", "column"),
    [
        ((100, 50), 6, 6),  # the crop's middle
        ((100 + 8, 50 - 4), 4, 10),
        ((100 + 0.9, 50 + 1.1), 7, 6),
        ((100 - 99, 50 + 99), 12, 0),  # beyond the crop: its edge
    ],
)
def test_a_place_has_the_nearest_one(place, row, column):
    values = np.arange(169, dtype=np.float32).reshape(13, 13) / 169
    search = np.stack([values, np.sqrt(1 - values**2)])
    target = np.array([1, 0], np.float32)[:, None, None]
    found = Resemblance(target, search, (100, 50), 2.0).at(place)
    assert found == pytest.approx(values[row, column], abs=1e-6)
