# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.middle.running_mean import RunningMean

FRAMES = [np.random.default_rng(k).normal(size=(3, 2)) for k in range(6)]


@pytest.mark.parametrize(("rate", "share"), [(0.1, 0.0), (0.1, 0.3), (1.0, 0.0), (0.5, 1.0)])
def test_means_are_those_of_the_formula(rate, share):
    mean = RunningMean(rate, share)
    wanted = FRAMES[0]
    for frame in FRAMES:
        mean.learn(frame, 2 * frame)
        mixed = (1 - share) * frame + share * FRAMES[0]
        wanted = (1 - rate) * wanted + rate * mixed
        np.testing.assert_allclose(mean.values[0], wanted, rtol=1e-12)
        np.testing.assert_allclose(mean.values[1], 2 * wanted, rtol=1e-12)


def test_nothing_is_known_before_the_first_frame():
    assert RunningMean(0.1, 0.1).values == ()


@pytest.mark.parametrize("weight", [0.0, 0.5])
def test_a_frame_counts_by_its_weight(weight):
    mean, slower = RunningMean(0.4, 0.2), RunningMean(0.4 * weight, 0.2)
    for each in (mean, slower):
        each.learn(FRAMES[0])
    mean.learn(FRAMES[1], weight=weight)
    slower.learn(FRAMES[1])
    np.testing.assert_allclose(mean.values[0], slower.values[0])


def test_what_is_learnt_stays_the_caller_s():
    mean, first = RunningMean(0.5, 0.5), FRAMES[0].copy()
    mean.learn(first)
    mean.learn(FRAMES[1])
    np.testing.assert_array_equal(first, FRAMES[0])


@pytest.mark.parametrize("dtype", [np.float32, np.complex64, np.float64])
def test_what_is_learnt_keeps_its_kind(dtype):
    mean = RunningMean(0.1, 0.1)
    for frame in FRAMES:
        mean.learn(frame.astype(dtype))
    assert mean.values[0].dtype == dtype
