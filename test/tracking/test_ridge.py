# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.ridge import RidgeEnsembles

ROWS, COLUMNS, M, Q = 9, 11, 4, 3
SIGMA = (1.5, 2.0)
CORNERS = np.array([[4.0, 3.0], [5.25, 4.5], [2.0, 6.0]])
EVERYONE = np.ones(Q, bool)


def maps(seed=0, dtype=np.float64):
    return np.random.default_rng(seed).normal(size=(M, ROWS, COLUMNS)).astype(dtype)


def ensembles(rate=0.25, ridge=0.3, emphasis=6.0, first_frame=0.0):
    return RidgeEnsembles(rate, ridge, SIGMA, emphasis, first_frame)


def slow_label(x, y, corner):
    dx, dy = (x - corner[0]) / SIGMA[0], (y - corner[1]) / SIGMA[1]
    return np.exp(-(dx * dx + dy * dy) / 2)


def slow_samples(features, corners, emphasis):
    """Design matrix, labels and weights, one place after the other."""
    design, labels, weights = [], [], []
    for y in range(ROWS):
        for x in range(COLUMNS):
            design.append([*features[:, y, x], 1.0])
            labels.append([slow_label(x, y, corner) for corner in corners])
            weights.append(1 + emphasis * max(labels[-1]))
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


def test_labels_are_the_gaussian_of_the_formula():
    labels = ensembles().labels(CORNERS, (ROWS, COLUMNS)).reshape(Q, ROWS, COLUMNS)
    for q in range(Q):
        for y in range(ROWS):
            for x in range(COLUMNS):
                assert labels[q, y, x] == pytest.approx(slow_label(x, y, CORNERS[q]))


@pytest.mark.parametrize("emphasis", [0.0, 10.0])
@pytest.mark.parametrize("ridge", [0.001, 0.5])
def test_the_first_fit_is_weighted_least_squares(ridge, emphasis):
    features = maps()
    fast = ensembles(ridge=ridge, emphasis=emphasis)
    fast.learn(features, CORNERS, EVERYONE)
    votes = slow_fit(*slow_samples(features, CORNERS, emphasis), ridge)
    other = maps(1)
    np.testing.assert_allclose(fast.score_maps(other), slow_scores(votes, other), atol=1e-9)


@pytest.mark.parametrize("kept", [0.0, 0.1, 1.0])
@pytest.mark.parametrize(("rate", "frames"), [(0.02, 3), (0.02, 30), (0.5, 3)])
def test_statistics_run_on_at_the_learning_rate(kept, rate, frames):
    """Frames blended weigh as their samples do, all at once, with the weights of the blend."""
    fast = ensembles(rate, first_frame=kept)
    samples, shares = [], np.eye(frames)[0]
    for frame in range(frames):
        fast.learn(maps(frame), CORNERS + frame / 2, EVERYONE)
        samples.append(slow_samples(maps(frame), CORNERS + frame / 2, 6.0))
        if frame:
            new = min(1, rate * max(1, 33 / (frame + 10)))  # the first ones weigh more
            shares *= 1 - new
            shares[frame] += new * (1 - kept)
            shares[0] += new * kept
    design, labels = (np.vstack([sample[k] for sample in samples]) for k in (0, 1))
    weights = np.concatenate(
        [share * sample[2] for share, sample in zip(shares, samples, strict=True)]
    )
    votes = slow_fit(design, labels, weights, 0.3)
    np.testing.assert_allclose(fast.score_maps(maps()), slow_scores(votes, maps()), atol=1e-9)


def test_labels_of_a_sub_patch_that_is_not_chosen_stay_as_they_were():
    chosen = np.array([True, False, True])
    some, everyone, nobody = (ensembles() for _ in range(3))
    for model, which in ((some, chosen), (everyone, EVERYONE), (nobody, ~EVERYONE)):
        model.learn(maps(0), CORNERS, EVERYONE)
        model.learn(maps(1), CORNERS + 1, which)
    scores, all_scores, old_scores = (m.score_maps(maps(2)) for m in (some, everyone, nobody))
    np.testing.assert_allclose(scores[chosen], all_scores[chosen])
    np.testing.assert_allclose(scores[~chosen], old_scores[~chosen])
    assert not np.allclose(scores[1], all_scores[1])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_what_comes_out_is_of_the_features_kind(dtype):
    model = ensembles()
    model.learn(maps(dtype=dtype), CORNERS, EVERYONE)
    scores = model.score_maps(maps(1, dtype))
    assert scores.dtype == dtype
    exact = ensembles()
    exact.learn(maps(dtype=dtype).astype(float), CORNERS, EVERYONE)
    np.testing.assert_allclose(scores, exact.score_maps(maps(1, dtype).astype(float)), atol=1e-4)


def test_likelihood_is_the_mean_score_at_the_nearest_places():
    model, features = ensembles(), maps()
    model.learn(features, CORNERS, EVERYONE)
    scores = model.score_maps(features)
    wanted = np.mean([scores[0, 3, 4], scores[1, 4, 5], scores[2, 6, 2]])
    nearby = CORNERS + np.array([[0.3, -0.4], [0.1, -0.3], [-0.4, 0.2]])
    assert model.likelihood(features, nearby) == pytest.approx(np.clip(wanted, 0, 1))


@pytest.mark.parametrize("corner", [(-40.0, 2.0), (3.0, 400.0), (0.0, 0.0), (10.0, 8.0)])
def test_corners_at_and_beyond_the_maps_border(corner):
    model, corners = ensembles(), np.tile(corner, (Q, 1))
    model.learn(maps(), corners, EVERYONE)
    assert np.isfinite(model.score_maps(maps())).all()
    assert 0 <= model.likelihood(maps(), corners) <= 1


def test_learns_to_tell_each_sub_patch_its_own_place():
    features = maps() / 10
    for channel, (x, y) in enumerate(CORNERS.astype(int)):
        features[channel, y, x] += 8
    model = ensembles(ridge=0.01, emphasis=10.0)
    model.learn(features, CORNERS, EVERYONE)
    for one, (x, y) in zip(model.score_maps(features), CORNERS.astype(int), strict=True):
        assert divmod(int(one.argmax()), COLUMNS) == (y, x)
        assert one[y, x] > 0.5 > np.median(one)


def test_flat_features_give_the_same_score_everywhere():
    model, flat = ensembles(), np.zeros((M, ROWS, COLUMNS))
    model.learn(flat, CORNERS, EVERYONE)
    scores = model.score_maps(flat)
    np.testing.assert_allclose(scores, scores[:, :1, :1] * np.ones((Q, ROWS, COLUMNS)))


@pytest.mark.parametrize("ask", ["score_maps", "likelihood"])
def test_scores_need_a_model(ask):
    arguments = (maps(), CORNERS) if ask == "likelihood" else (maps(),)
    with pytest.raises(RuntimeError, match="learn first"):
        getattr(ensembles(), ask)(*arguments)


def test_features_far_larger_than_the_regularisation():
    """What comes after a flat first frame; the matrix is then singular in float32."""
    features = 1e6 * np.repeat(maps(dtype=np.float32)[:1], M, axis=0)
    model = ensembles(ridge=1e-9)
    model.learn(features, CORNERS, EVERYONE)
    scores = model.score_maps(features)
    assert np.isfinite(scores).all()
    assert np.abs(scores).max() < 2
