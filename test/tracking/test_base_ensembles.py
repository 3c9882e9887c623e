# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest
import reference

from het_ros.tracking.base_ensembles import (
    Gaussians,
    NaiveBayes,
    detect,
    sample_gaussians,
    scores_at,
)

EVERYONE = np.ones(2, bool)


def maps(seed=0, m=6, rows=30, columns=34):
    return np.random.default_rng(seed).normal(size=(m, rows, columns))


def ensembles(rate=0.85, floor=0.05):
    return NaiveBayes(rate, 4.0, 8.0, floor)


@pytest.mark.parametrize("keep", [0.0, 0.5, 0.85, 1.0])
def test_parameter_update_follows_the_equation(keep):
    rng = np.random.default_rng(1)
    old = Gaussians(rng.normal(size=(2, 5)), rng.uniform(0.1, 2, (2, 5)))
    samples = rng.normal(size=(2, 5, 20))
    new = Gaussians(samples.mean(axis=2), samples.var(axis=2))
    mean, variance = old.mean.copy(), old.variance.copy()
    old.blend(new, keep, np.array([True, False]))
    for i in range(5):
        mu, sigma = reference.blended(
            mean[0, i], math.sqrt(variance[0, i]), list(samples[0, i]), keep
        )
        assert old.mean[0, i] == pytest.approx(mu)
        assert math.sqrt(old.variance[0, i]) == pytest.approx(sigma)
    np.testing.assert_array_equal(old.mean[1], mean[1])
    np.testing.assert_array_equal(old.variance[1], variance[1])


def test_blending_equals_pooling_the_samples():
    """With as many old as new samples and lambda = 1/2 nothing but pooling would be right."""
    a, b = np.random.default_rng(2).normal(size=(2, 1, 3, 50)) + np.arange(2).reshape(2, 1, 1, 1)
    old = Gaussians(a.mean(axis=2), a.var(axis=2))
    old.blend(Gaussians(b.mean(axis=2), b.var(axis=2)), 0.5, np.ones(1, bool))
    pooled = np.concatenate([a, b], axis=2)
    np.testing.assert_allclose(old.mean, pooled.mean(axis=2))
    np.testing.assert_allclose(old.variance, pooled.var(axis=2))


def test_sample_gaussians():
    features = maps()
    samples = np.random.default_rng(3).random((2, 30, 34)) < 0.1
    found = sample_gaussians(features, samples)
    for q in range(2):
        np.testing.assert_allclose(found.mean[q], features[:, samples[q]].mean(axis=1))
        np.testing.assert_allclose(found.variance[q], features[:, samples[q]].var(axis=1))


def test_the_floor_bounds_what_a_flat_feature_says():
    features = np.zeros((6, 30, 34))
    bayes = ensembles(floor=0.5)
    bayes.learn(features, np.array([[15.0, 15], [12, 9]]), EVERYONE)
    np.testing.assert_array_equal(bayes.score_maps(features), 0)
    assert np.isfinite(bayes.score_maps(maps())).all()


def test_learns_to_tell_the_target_from_its_surroundings():
    features = maps()
    features[:, 12:19, 12:19] += 3
    bayes = ensembles()
    bayes.learn(features, np.array([[15.0, 15], [15, 15]]), EVERYONE)
    scores = bayes.score_maps(features)
    assert scores[0, 15, 15] > 0 > scores[0, 2, 2]
    likely, unlikely = (bayes.likelihood(features, np.full((2, 2), i)) for i in (15.0, 2.0))
    assert 0 <= unlikely < 0.5 < likely <= 1


@pytest.mark.parametrize("corner", [(-30.0, -30.0), (200.0, 5.0), (0.0, 0.0), (33.0, 29.0)])
def test_sub_patches_at_and_beyond_the_maps_border(corner):
    bayes = ensembles()
    bayes.learn(maps(), np.array([corner, corner]), EVERYONE)
    scores = bayes.score_maps(maps())
    assert np.isfinite(scores).all()
    assert np.isfinite(scores_at(scores, np.array([corner, corner]))).all()
    found = detect(scores, np.array([corner, corner]), 5.0)
    assert (found.corners >= 0).all()
    assert (found.corners < [34, 30]).all()


def test_maps_smaller_than_the_radii():
    tiny = maps(rows=1, columns=1)
    bayes = ensembles()
    bayes.learn(tiny, np.zeros((2, 2)), EVERYONE)
    np.testing.assert_allclose(bayes.score_maps(tiny), 0, atol=1e-12)


def test_scores_need_a_model():
    with pytest.raises(RuntimeError, match="learn first"):
        ensembles().score_maps(maps())


@pytest.mark.parametrize(
    ("peaks", "found"),
    [
        ({(10, 12): 5.0}, (10, 12)),
        ({(10, 12): 5.0, (18, 10): 9.0}, (10, 12)),  # better, but out of reach
        ({}, (11, 11)),  # nothing to go by: stays
        ({(9, 11): 5.0, (12, 11): 5.0}, (12, 11)),  # the nearer of equals
    ],
)
def test_detect_takes_the_best_place_in_the_disc(peaks, found):
    scores = np.zeros((1, 30, 34))
    for (x, y), value in peaks.items():
        scores[0, y, x] = value
    detections = detect(scores, np.array([[11.2, 11.1]]), 6.0)
    assert tuple(detections.corners[0]) == found
    assert detections.scores[0] == scores[0, found[1], found[0]]
