# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.paper.combination import (
    average_error,
    combine,
    combined_error,
    hypotheses,
    weights,
)

from . import reference


@pytest.mark.parametrize(
    ("scores", "wanted"),
    [
        ([1, 2, 3], [0.1, 0.5, 0.9]),
        ([-1e6, 0, 1e6], [0.1, 0.5, 0.9]),
        ([0, 0, 8], [0.1, 0.1, 0.9]),
        ([4, 4, 4], [0.5, 0.5, 0.5]),
        ([-3], [0.5]),
    ],
)
def test_weights(scores, wanted):
    np.testing.assert_allclose(weights(np.array(scores, float), 0.1, 0.9), wanted)


def test_weights_as_in_the_reference():
    for scores in np.random.default_rng(0).normal(size=(50, 11)) * 300:
        omega = weights(scores, 0.1, 0.9)
        np.testing.assert_allclose(omega, reference.weights(list(scores), 0.1, 0.9))
        assert omega.min() == pytest.approx(0.1)
        assert omega.max() == pytest.approx(0.9)


def test_a_target_that_moved_as_one_has_one_hypothesis():
    offsets = np.array([[0.0, 2], [3, 1], [4, 4]])
    candidates = hypotheses(np.array([20.0, 30]) + offsets, offsets)
    np.testing.assert_array_equal(candidates, [[20, 30]] * 3)


def test_combination_is_the_weighted_mean():
    candidates = np.array([[0.0, 10], [10, 20]])
    np.testing.assert_allclose(combine(candidates, np.array([0.9, 0.1])), [1, 11])


def test_combining_errs_less_than_the_average():
    """E_COM <= E_AV / W (eq. 13), and as often as that holds in fact."""
    rng = np.random.default_rng(0)
    truth = np.array([50.0, 60])
    squared, promised = [], []
    omega = rng.uniform(0.1, 0.9, 11)
    for _ in range(2000):
        candidates = truth + rng.normal(size=(11, 2)) * 3
        e_av = average_error(candidates, omega, truth)
        e_com = combined_error(candidates, omega, truth)
        assert e_com <= e_av / omega.sum() + 1e-12
        squared.append(((combine(candidates, omega) - truth) ** 2).sum())
        promised.append(e_com)
    assert np.mean(squared) == pytest.approx(np.mean(promised), rel=0.1)
