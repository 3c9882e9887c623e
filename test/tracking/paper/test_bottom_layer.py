# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from het_ros.tracking.features.buffers import Buffers
from het_ros.tracking.paper.base_ensembles import mean_probability, score_maps
from het_ros.tracking.paper.detection import detect, scores_at
from het_ros.tracking.paper.model_update import blended, class_gaussians, to_be_updated, updated
from het_ros.tracking.paper.weak_classifiers import Gaussians, WeakClassifiers, fit_gaussians

from . import reference

EVERYONE = np.ones(2, bool)


def maps(seed=0, m=6, rows=30, columns=34):
    return np.random.default_rng(seed).normal(size=(m, rows, columns))


def learnt(features, corners, floor=0.05):
    positive, negative = class_gaussians(features, np.array(corners, float), 4.0, 8.0, Buffers())
    return WeakClassifiers(positive, negative, floor)


@pytest.mark.parametrize("rate", [0.0, 0.15, 0.5, 1.0])
def test_parameter_update_follows_the_equation(rate):
    rng = np.random.default_rng(1)
    old = Gaussians(rng.normal(size=(2, 5)), rng.uniform(0.1, 2, (2, 5)))
    samples = rng.normal(size=(2, 5, 20))
    new = Gaussians(samples.mean(axis=2), samples.var(axis=2))
    found = blended(old, new, rate, np.array([True, False]))
    for i in range(5):
        mu, sigma = reference.blended(
            old.mean[0, i], math.sqrt(old.variance[0, i]), list(samples[0, i]), 1 - rate
        )
        assert found.mean[0, i] == pytest.approx(mu)
        assert math.sqrt(found.variance[0, i]) == pytest.approx(sigma)
    np.testing.assert_array_equal(found.mean[1], old.mean[1])
    np.testing.assert_array_equal(found.variance[1], old.variance[1])


def test_blending_equals_pooling_the_samples():
    """With as many old as new samples and lambda = 1/2 nothing but pooling would be right."""
    a, b = np.random.default_rng(2).normal(size=(2, 1, 3, 50)) + np.arange(2).reshape(2, 1, 1, 1)
    old, new = (Gaussians(x.mean(axis=2), x.var(axis=2)) for x in (a, b))
    found = blended(old, new, 0.5, np.ones(1, bool))
    pooled = np.concatenate([a, b], axis=2)
    np.testing.assert_allclose(found.mean, pooled.mean(axis=2))
    np.testing.assert_allclose(found.variance, pooled.var(axis=2))


def test_both_classes_are_updated():
    old, new = (learnt(maps(seed), [(15, 15), (12, 9)]) for seed in (0, 1))
    found = updated(old, new.positive, new.negative, 1.0, np.array([False, True]))
    for one in ("positive", "negative"):
        wanted = np.array([getattr(old, one).mean[0], getattr(new, one).mean[1]])
        np.testing.assert_allclose(getattr(found, one).mean, wanted)


def test_mean_and_variance_of_samples():
    features = maps()
    samples = np.random.default_rng(3).random((2, 30, 34)) < 0.1
    found = fit_gaussians(features, samples, np.empty(2 * features.size))
    for q in range(2):
        np.testing.assert_allclose(found.mean[q], features[:, samples[q]].mean(axis=1))
        np.testing.assert_allclose(found.variance[q], features[:, samples[q]].var(axis=1))


def test_scores_are_the_log_ratios_added_up():
    features = maps()
    classifiers = learnt(features, [(15, 15), (12, 9)])
    scores = score_maps(classifiers, features, Buffers())
    for q in range(2):
        slow = [
            reference.log_normal(
                features[i, 7, 11],
                classifiers.positive.mean[q, i],
                math.sqrt(classifiers.positive.variance[q, i]),
            )
            - reference.log_normal(
                features[i, 7, 11],
                classifiers.negative.mean[q, i],
                math.sqrt(classifiers.negative.variance[q, i]),
            )
            for i in range(6)
        ]
        here = np.tile(features[:, 7, 11], (2, 1))
        np.testing.assert_allclose(classifiers.log_ratios(here)[q], slow)
        assert scores[q, 7, 11] == pytest.approx(sum(slow))


def test_the_floor_bounds_what_a_flat_feature_says():
    features = np.zeros((6, 30, 34))
    classifiers = learnt(features, [(15, 15), (12, 9)], floor=0.5)
    np.testing.assert_array_equal(score_maps(classifiers, features, Buffers()), 0)
    assert np.isfinite(score_maps(classifiers, maps(), Buffers())).all()


def test_learns_to_tell_the_target_from_its_surroundings():
    features = maps()
    features[:, 12:19, 12:19] += 3
    classifiers = learnt(features, [(15, 15), (15, 15)])
    scores = score_maps(classifiers, features, Buffers())
    assert scores[0, 15, 15] > 0 > scores[0, 2, 2]
    likely, unlikely = (
        mean_probability(classifiers, features, np.full((2, 2), i)) for i in (15.0, 2.0)
    )
    assert 0 <= unlikely < 0.5 < likely <= 1


@pytest.mark.parametrize("corner", [(-30.0, -30.0), (200.0, 5.0), (0.0, 0.0), (33.0, 29.0)])
def test_sub_patches_at_and_beyond_the_maps_border(corner):
    corners = np.array([corner, corner])
    scores = score_maps(learnt(maps(), corners), maps(), Buffers())
    assert np.isfinite(scores).all()
    assert np.isfinite(scores_at(scores, corners)).all()
    found = detect(scores, corners, 5.0)
    assert (found.corners >= 0).all()
    assert (found.corners < [34, 30]).all()


def test_maps_smaller_than_the_radii():
    tiny = maps(rows=1, columns=1)
    scores = score_maps(learnt(tiny, np.zeros((2, 2))), tiny, Buffers())
    np.testing.assert_allclose(scores, 0, atol=1e-12)


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


@pytest.mark.parametrize(
    ("scores", "chosen"),
    [
        ([0, 1, 2, 3, 4], [False, True, True, True, False]),
        ([5, 5, 5, 5, -100], [True, True, True, True, False]),
        ([1, -1], [False, False]),  # both on the open interval's ends
        ([3, 3, 3], [True, True, True]),
        ([7], [True]),
    ],
)
def test_which_to_update(scores, chosen):
    assert to_be_updated(np.array(scores, float)).tolist() == chosen


def test_which_to_update_as_in_the_reference():
    rng = np.random.default_rng(0)
    for scores in rng.normal(size=(50, 11)):
        assert to_be_updated(scores).tolist() == reference.selected(list(scores))
