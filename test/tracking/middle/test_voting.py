# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.middle.voting import best_place, distractor, parabola_offset


@pytest.mark.parametrize("top", [-0.49, -0.2, 0.0, 0.13, 0.5])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_top_of_a_parabola_is_found_exactly(top, dtype):
    values = (3 - 0.7 * (np.arange(7) - (3 + top)) ** 2).astype(dtype)
    assert parabola_offset(values, 3) == pytest.approx(top, abs=1e-5)


@pytest.mark.parametrize("sigma", [1.5, 3.0])
@pytest.mark.parametrize("top", np.linspace(-0.5, 0.5, 9))
def test_the_top_of_a_gaussian_is_found_nearly(top, sigma):
    values = np.exp(-0.5 * ((np.arange(21) - (10 + top)) / sigma) ** 2)
    assert parabola_offset(values, 10) == pytest.approx(top, abs=0.05)


@pytest.mark.parametrize(
    ("values", "peak", "offset"),
    [
        ([5.0, 1.0, 0.0], 0, 0.0),  # at an end there is nothing to go by
        ([0.0, 1.0, 5.0], 2, 0.0),
        ([1.0], 0, 0.0),
        ([2.0, 2.0, 2.0], 1, 0.0),  # flat
        ([3.0, 1.0, 3.0], 1, 0.0),  # a hollow has no top
        ([0.0, 1.0, 1.0], 1, 0.5),  # between two equals
        ([1.0, 1.0, 0.0], 1, -0.5),
        ([0.0, 1.0, 1.9], 1, 0.5),  # not the highest: never farther than half a sample
    ],
)
def test_special_cases(values, peak, offset):
    assert parabola_offset(np.array(values), peak) == pytest.approx(offset)


PLACES = (14, 17)
CELLS = (10, 8)


def bump(at, sigma=2.0, height=1.0):
    """A response map with one smooth peak at (x, y)."""
    rows, columns = np.mgrid[: PLACES[0], : PLACES[1]]
    far = (columns - at[0]) ** 2 + (rows - at[1]) ** 2
    return (height * np.exp(-0.5 * far / sigma**2)).astype(np.float32)


@pytest.mark.parametrize("at", [(7.0, 6.0), (7.3, 5.6), (4.5, 8.25), (11.9, 3.1)], ids=str)
def test_a_smooth_peak_is_found_between_the_cells(at):
    peak = best_place(bump(at))
    np.testing.assert_allclose(peak.corner, at, atol=0.05)
    assert abs(peak.column - at[0]) <= 0.5
    assert abs(peak.row - at[1]) <= 0.5


@pytest.mark.parametrize("at", [(0.0, 0.0), (16.0, 13.0), (0.0, 13.0), (8.0, 0.0)], ids=str)
def test_a_peak_at_the_edge(at):
    peak = best_place(bump(at))
    np.testing.assert_array_equal(peak.corner, at)
    assert (peak.column, peak.row) == at


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1)])
def test_few_places(shape):
    peak = best_place(np.zeros(shape, np.float32))
    np.testing.assert_array_equal(peak.corner, (0, 0))


@pytest.mark.parametrize("cells", [CELLS, (4, 4), (24, 60)], ids=str)
@pytest.mark.parametrize("seed", range(4))
def test_the_distractor_against_loops(seed, cells):
    """The highest of all places farther than .35 of the target's side, 2 cells at least."""
    template = np.random.default_rng(seed).normal(size=PLACES).astype(np.float32)
    before, peak = template.copy(), best_place(template)
    apart = [max(2, round(0.35 * side)) for side in cells]
    wanted = -1.0
    for y in range(PLACES[0]):
        for x in range(PLACES[1]):
            if abs(x - peak.column) > apart[0] or abs(y - peak.row) > apart[1]:
                wanted = max(wanted, float(template[y, x]))
    assert distractor(template, peak, cells) == pytest.approx(wanted)
    np.testing.assert_array_equal(template, before)


def test_a_second_target_is_the_distractor():
    both = np.maximum(bump((3, 3), 1.0), bump((13, 9), 1.0, height=0.8))
    assert distractor(both, best_place(both), CELLS) == pytest.approx(0.8, abs=0.02)
    alone = bump((3, 3), 1.0)
    assert distractor(alone, best_place(alone), CELLS) < 0.05


def test_where_all_is_near_there_is_no_distractor():
    assert distractor(bump((3, 3)), best_place(bump((3, 3))), (60, 60)) == -1
