# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from het_ros.evaluation.metrics import centre_errors, overlaps, score

coordinates = st.floats(-1e3, 1e3)
sides = st.floats(0.5, 1e3)
boxes = st.tuples(coordinates, coordinates, sides, sides)


def runs(n=6):
    places = arrays(np.float64, (n, 2), elements=coordinates)
    sizes = arrays(np.float64, (n, 2), elements=sides)
    return st.builds(lambda p, s: np.hstack([p, s]), places, sizes)


@given(runs(), runs())
def test_overlap_is_symmetric_and_a_share(a, b):
    shared = overlaps(a, b)
    assert ((shared >= 0) & (shared <= 1 + 1e-9)).all()
    np.testing.assert_allclose(shared, overlaps(b, a))


@given(runs(), runs(), st.tuples(coordinates, coordinates))
def test_moving_both_changes_nothing(a, b, step):
    shift = np.array([*step, 0, 0])
    np.testing.assert_allclose(overlaps(a + shift, b + shift), overlaps(a, b), atol=1e-6)
    np.testing.assert_allclose(centre_errors(a + shift, b + shift), centre_errors(a, b), atol=1e-6)


@given(runs(), runs(), st.floats(0.1, 10))
def test_overlap_and_normalised_precision_do_not_depend_on_the_resolution(a, b, factor):
    np.testing.assert_allclose(overlaps(a * factor, b * factor), overlaps(a, b), atol=1e-9)


@given(runs(), runs())
def test_figures_are_shares_that_fit_together(a, truth):
    result = score(a, truth)
    assert 0 <= result.auc <= 20 / 21 + 1e-9
    assert (np.diff(result.success) <= 0).all()
    assert (np.diff(result.precision) >= 0).all()
    # 21 thresholds 0.05 apart turn the mean overlap into the AUC, up to their distance.
    assert result.auc == pytest.approx(result.mean_overlap, abs=0.05)


@given(runs(), runs(), st.integers(1, 5))
def test_a_frame_that_is_not_valid_counts_for_nothing(a, truth, row):
    absent = truth.copy()
    absent[row] = np.nan
    elsewhere = a.copy()
    elsewhere[row] += (5e3, 5e3, 0, 0)
    assert score(a, absent).auc == score(elsewhere, absent).auc
    assert score(a, absent).frames == 5
