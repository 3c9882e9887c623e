# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.bottom.ridge import RidgeRegression

ROWS, COLUMNS, M, Q = 9, 11, 4, 3
SIDE = 12.5
SIGMA, EMPHASIS = 0.12 * SIDE, 20.0
CORNERS = np.array([[4.0, 3.0], [5.25, 4.5], [2.0, 6.0]])


def maps(seed=0, dtype=np.float64):
    return np.random.default_rng(seed).normal(size=(M, ROWS, COLUMNS)).astype(dtype)


def regression(rates=(0.25,), ridge=0.3, first_frame=0.0):
    return RidgeRegression(rates, ridge, SIDE, first_frame)


def slow_label(x, y, corner):
    return np.exp(-((x - corner[0]) ** 2 + (y - corner[1]) ** 2) / SIGMA**2 / 2)


def slow_samples(features, corners):
    """Design matrix, labels and weights, one place after the other."""
    design, labels, weights = [], [], []
    for y in range(ROWS):
        for x in range(COLUMNS):
            design.append([*features[:, y, x], 1.0])
            labels.append([slow_label(x, y, corner) for corner in corners])
            weights.append(1 + EMPHASIS * max(labels[-1]))
    weights = np.array(weights)
    return np.array(design), np.array(labels), weights / weights.sum()


def slow_fit(design, labels, weights, ridge):
    """min sum w (a . l - y)^2 + ridge |a|^2 as a plain least-squares problem."""
    root = np.sqrt(weights)[:, None]
    stacked = np.vstack([root * design, np.sqrt(ridge) * np.eye(M + 1)])
    wanted = np.vstack([root * labels, np.zeros((M + 1, labels.shape[1]))])
    return np.linalg.lstsq(stacked, wanted, rcond=None)[0]


def slow_scores(votes, features):
    scores = np.empty((votes.shape[1], ROWS, COLUMNS))
    for q in range(votes.shape[1]):
        for y in range(ROWS):
            for x in range(COLUMNS):
                scores[q, y, x] = sum(votes[:-1, q] * features[:, y, x]) + votes[-1, q]
    return scores


def slow_shares(rate, kept, weights):
    """How much each frame counts after all are blended, the first ones faster."""
    shares = np.eye(len(weights))[0]
    for frame, weight in enumerate(weights[1:], 1):
        new = min(1.0, rate * weight * max(1.0, 33 / (frame + 10)))
        shares = shares * (1 - new)
        shares[frame] += new * (1 - kept)
        shares[0] += new * kept
    return shares


def test_labels_are_the_gaussian_of_the_formula():
    labels = regression().labels(CORNERS, (ROWS, COLUMNS)).reshape(Q, ROWS, COLUMNS)
    for q in range(Q):
        for y in range(ROWS):
            for x in range(COLUMNS):
                assert labels[q, y, x] == pytest.approx(slow_label(x, y, CORNERS[q]), abs=1e-6)


@pytest.mark.parametrize("ridge", [0.001, 0.5])
def test_the_first_fit_is_weighted_least_squares(ridge):
    features, other = maps(), maps(1)
    fast = regression(ridge=ridge)
    fast.learn(features, CORNERS, 1.0)
    votes = slow_fit(*slow_samples(features, CORNERS), ridge)
    np.testing.assert_allclose(fast.score_maps(other), slow_scores(votes, other), atol=1e-5)


@pytest.mark.parametrize("kept", [0.0, 0.1, 1.0])
@pytest.mark.parametrize(
    ("rates", "weights"),
    [
        ((0.02,), (1.0,) * 3),
        ((0.02,), (1.0,) * 30),
        ((0.02, 0.5), (1.0,) * 6),
        ((0.015, 0.05), (1.0, 0.3, 1.0, 0.7, 0.0001, 1.0)),
    ],
    ids=["a few frames", "many", "two rates", "frames that count less"],
)
def test_the_mean_of_the_fits_of_all_samples_at_once(kept, rates, weights):
    """Frames blended weigh as their samples do; only the slow fit keeps the first frame."""
    fast = regression(rates, first_frame=kept)
    samples = []
    for frame, weight in enumerate(weights):
        fast.learn(maps(frame), CORNERS + frame / 9, weight)
        samples.append(slow_samples(maps(frame), CORNERS + frame / 9))
    design, labels = (np.vstack([sample[k] for sample in samples]) for k in (0, 1))
    fits = []
    for number, rate in enumerate(rates):
        shares = slow_shares(rate, 0.0 if number else kept, weights)
        weighted = [share * s[2] for share, s in zip(shares, samples, strict=True)]
        fits.append(slow_fit(design, labels, np.concatenate(weighted), 0.3))
    votes = np.mean(fits, axis=0)
    np.testing.assert_allclose(fast.weights, votes, atol=1e-5)
    np.testing.assert_allclose(fast.score_maps(maps()), slow_scores(votes, maps()), atol=1e-5)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_what_comes_out_is_of_the_features_kind(dtype):
    model = regression()
    model.learn(maps(dtype=dtype), CORNERS, 1.0)
    scores = model.score_maps(maps(1, dtype))
    assert scores.dtype == dtype
    exact = regression()
    exact.learn(maps(dtype=dtype).astype(float), CORNERS, 1.0)
    np.testing.assert_allclose(scores, exact.score_maps(maps(1, dtype).astype(float)), atol=1e-4)


@pytest.mark.parametrize("corner", [(-40.0, 2.0), (3.0, 400.0), (0.0, 0.0), (10.0, 8.0)])
def test_corners_at_and_beyond_the_maps_border(corner):
    model = regression()
    model.learn(maps(), np.tile(corner, (Q, 1)), 1.0)
    assert np.isfinite(model.score_maps(maps())).all()


def test_learns_to_tell_each_sub_patch_its_own_place():
    features = maps() / 10
    for channel, (x, y) in enumerate(CORNERS.astype(int)):
        features[channel, y, x] += 8
    model = regression(ridge=0.01)
    model.learn(features, CORNERS, 1.0)
    for one, (x, y) in zip(model.score_maps(features), CORNERS.astype(int), strict=True):
        assert divmod(int(one.argmax()), COLUMNS) == (y, x)
        assert one[y, x] > 0.5 > np.median(one)


def test_flat_features_give_the_same_score_everywhere():
    model, flat = regression(), np.zeros((M, ROWS, COLUMNS))
    model.learn(flat, CORNERS, 1.0)
    scores = model.score_maps(flat)
    np.testing.assert_allclose(scores, scores[:, :1, :1] * np.ones((Q, ROWS, COLUMNS)))


def test_scores_need_a_model():
    with pytest.raises(RuntimeError, match="learn first"):
        regression().score_maps(maps())


def test_features_far_larger_than_the_regularisation():
    """What comes after a flat first frame; the matrix is then singular in float32."""
    features = 1e6 * np.repeat(maps(dtype=np.float32)[:1], M, axis=0)
    model = regression(ridge=1e-9)
    model.learn(features, CORNERS, 1.0)
    scores = model.score_maps(features)
    assert np.isfinite(scores).all()
    assert np.abs(scores).max() < 2
