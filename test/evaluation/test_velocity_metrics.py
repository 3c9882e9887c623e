# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Velocity figures against slow obvious code and on motions whose figures are known."""

import numpy as np
import pytest
from filterpy.kalman import KalmanFilter

from het_ros.evaluation import velocity_metrics as metrics

DT = 1 / 30


def walk(n=60, seed=0, step=2.0):
    return np.cumsum(np.random.default_rng(seed).normal(0, step, (n, 2)), axis=0)


def sine(n=200, period=40, late=0.0):
    """A velocity that swings in x and stands still in y."""
    t = np.arange(n) - late
    return np.stack([100 * np.sin(2 * np.pi * t / period), np.zeros(n)], axis=1)


@pytest.mark.parametrize("gap", [None, 20])
def test_the_derivative_is_that_of_a_quadratic_fit(gap):
    places = walk()
    if gap:
        places[gap] = np.nan
    found = metrics.derivative(places, DT)
    steps = np.arange(-5, 6)
    for row in range(len(places)):
        window = places[max(row - 5, 0) : row + 6]
        if len(window) < 11 or np.isnan(window).any():
            assert np.isnan(found[row]).all()
            continue
        for axis in (0, 1):
            slope = np.polyfit(steps * DT, window[:, axis], 2)[1]
            assert found[row, axis] == pytest.approx(slope)


def test_a_short_run_has_no_derivative():
    assert np.isnan(metrics.derivative(walk(10), DT)).all()
    assert np.isfinite(metrics.derivative(walk(11), DT)).sum() == 2


def test_differences():
    found = metrics.differences(np.array([[0.0, 0], [1, 2], [3, 2]]), 0.5)
    assert np.isnan(found[0]).all()
    assert found[1:].tolist() == [[2, 4], [4, 0]]


def test_the_filter_is_filterpys():
    places, side, dt = walk(), 30.0, 0.1
    places[17:20] = np.nan
    slow = KalmanFilter(dim_x=4, dim_z=2)
    slow.x = np.array([*places[0], 0, 0])[:, None]
    slow.F = np.eye(4) + dt * np.eye(4, k=2)
    slow.H = np.eye(2, 4)
    measured, swing = (0.05 * side) ** 2, (10 * side) ** 2
    slow.P = np.diag([measured, measured, side**2, side**2])
    slow.R = measured * np.eye(2)
    a, b, c = dt**4 / 4, dt**3 / 2, dt**2
    slow.Q = swing * np.block([[a * np.eye(2), b * np.eye(2)], [b * np.eye(2), c * np.eye(2)]])
    centres, velocities, variances = metrics.filtered(places, side, dt)
    for row, place in enumerate(places):
        if row:
            slow.predict()
            if np.isfinite(place).all():
                slow.update(place[:, None])
        np.testing.assert_allclose(np.r_[centres[row], velocities[row]], slow.x[:, 0], atol=1e-6)
        assert variances[row] == pytest.approx(slow.P[2, 2])


def test_the_filter_knows_an_even_motion():
    places = np.outer(np.arange(90), [3.0, -1.0])
    _, velocities, _ = metrics.filtered(places, 40.0, DT)
    np.testing.assert_allclose(velocities[-1], [90, -30], rtol=0.01)


def test_the_filter_does_not_depend_on_the_units():
    places = walk()
    _, one, _ = metrics.filtered(places, 20.0, DT)
    _, ten, _ = metrics.filtered(10 * places, 200.0, DT)
    np.testing.assert_allclose(10 * one, ten)


@pytest.mark.parametrize(
    ("vectors", "length"),
    [([[3, 4]], 5), ([[3, 4], [0, 0]], 12.5**0.5), ([[3, 4], [np.nan, 0]], 5), ([], None)],
)
def test_root_mean_square(vectors, length):
    assert metrics.rms(np.array(vectors, float).reshape(-1, 2)) == pytest.approx(length)


def test_changes_are_between_neighbours_that_both_count():
    velocities = np.array([[0.0, 0], [1, 0], [3, 0], [6, 0], [10, 0]])
    found = metrics.changes(velocities, np.array([True, True, False, True, True]))
    np.testing.assert_array_equal(found[:, 0], [np.nan, 1, np.nan, np.nan, 4])


@pytest.mark.parametrize("late", [-3.0, 0.0, 1.0, 1.5, 2.25, 7.0])
def test_a_late_sine_has_its_lag_back(late):
    assert metrics.lag(sine(late=late), sine()) == pytest.approx(late, abs=0.05)


@pytest.mark.parametrize("late", [1.0, 3.5])
def test_lag_bears_noise_gaps_scale_and_an_even_part(late):
    noise = np.random.default_rng(2).normal(0, 30, (200, 2))
    said = 0.5 * sine(late=late) + noise + [500, 0]
    said[60:70] = np.nan
    assert metrics.lag(said, sine()) == pytest.approx(late, abs=0.5)


@pytest.mark.parametrize(
    "said",
    [
        np.zeros((200, 2)),  # says nothing
        np.random.default_rng(0).normal(0, 1, (200, 2)),  # something else
        np.full((200, 2), np.nan),
        -sine(period=200),  # the other way
        sine(late=15.0, period=80),  # later than is looked for
    ],
)
def test_what_has_no_lag_is_given_none(said):
    truth = sine(period=200) if said[1, 0] < 0 else sine(period=80)
    assert metrics.lag(said, truth) is None


def test_the_whole_shift_of_the_lag_is_the_best_of_all():
    truth, said = sine(), sine(late=4.0) + np.random.default_rng(5).normal(0, 20, (200, 2))

    def correlated(shift):
        pairs = [(said[i + shift], truth[i]) for i in range(200) if 0 <= i + shift < 200]
        a, b = (np.array(of) for of in zip(*pairs, strict=True))
        return np.corrcoef((a - a.mean(0)).ravel(), (b - b.mean(0)).ravel())[0, 1]

    best = max(range(-10, 11), key=correlated)
    assert abs(metrics.lag(said, truth) - best) <= 0.5


def test_a_true_covariance_holds_95_percent_and_a_small_one_does_not():
    draw = np.random.default_rng(3)
    wide = np.array([[4.0, 1.0], [1.0, 2.0]])
    errors = draw.multivariate_normal([0, 0], wide, 4000)
    said = np.tile(wide, (4000, 1, 1))
    assert metrics.share_within(errors, said) == pytest.approx(0.95, abs=0.02)
    assert metrics.share_within(errors, said / 9) < 0.5


def test_the_share_within_leaves_out_what_is_not_known():
    errors = np.array([[0.0, 0], [np.nan, 0], [9, 9], [0, 0]])
    covariances = np.stack([np.eye(2), np.eye(2), np.full((2, 2), np.nan), np.zeros((2, 2))])
    assert metrics.share_within(errors, covariances) == 1.0
    assert metrics.share_within(errors[1:], covariances[1:]) is None


@pytest.mark.parametrize(
    ("seconds", "dt", "places"),
    [
        (0.1, 0.1, [1, 4, 9, np.nan]),
        (0.2, 0.1, [4, 9, np.nan, np.nan]),
        (0.1, 1 / 15, [2.5, 6.5, np.nan, np.nan]),  # half way between two frames
        (0.1, 0.4, [0.25, 1.75, 5.25, np.nan]),
        (0.5, 0.1, [np.nan] * 4),
    ],
)
def test_the_place_some_time_ahead(seconds, dt, places):
    given = np.repeat([[0.0], [1.0], [4.0], [9.0]], 2, axis=1)
    np.testing.assert_allclose(metrics.ahead(given, seconds, dt)[:, 0], places)


def test_prediction_errors_of_an_even_motion():
    """60 px/s and a side of 20 px: after 0.2 s who stays is 12 px off, .6 sides."""
    n = 40
    truth = np.stack([2.0 * np.arange(n), np.zeros(n), np.full(n, 20.0), np.full(n, 20.0)], 1)
    places = metrics.centres(truth)
    predictors = {
        "stays": lambda seconds: places,
        "moves": lambda seconds: places + seconds * np.array([60.0, 0]),
        "silent": lambda seconds: np.full_like(places, np.nan),
    }
    use = np.ones(n, bool)
    found = metrics.prediction_errors(predictors, truth, use, (0.2,), DT)["0.2"]
    assert found["stays"] == pytest.approx(0.6)
    assert found["moves"] == pytest.approx(0, abs=1e-9)
    assert found["silent"] is None
