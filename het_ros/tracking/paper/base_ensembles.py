# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Base ensembles: the weak classifiers of a sub-patch added up to a strong one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.buffers import Buffers
from het_ros.tracking.features.compressive import FeatureMaps
from het_ros.tracking.paper.detection import nearest_places
from het_ros.tracking.paper.weak_classifiers import WeakClassifiers, rows_in_fours

Floats = NDArray[np.float64]

_LARGEST_LOG_RATIO = 50.0  # beyond it a probability is 0 or 1 to float64's precision; geometry


def score_maps(
    classifiers: WeakClassifiers, features: FeatureMaps, scratch: Buffers
) -> FeatureMaps:
    """F(l) = sum of f(l_i), eq. (6) "strongClassifier", of every sub-patch at every place.

    f is quadratic in the feature, so all sub-patches at all places are one matrix product,
    (Q, 2 m) by (2 m, places), done in two halves to copy nothing.

    Args:
        classifiers: of Q sub-patches.
        features: (m, rows, columns), normalised.
        scratch: where the features' squares are put.

    Returns:
        (Q, rows, columns), of the features' dtype.
    """
    quadratic, linear, constant = classifiers.coefficients()
    flat = features.reshape(len(features), -1)
    squares = np.multiply(flat, flat, out=scratch.empty(flat.shape, flat.dtype))
    scores = rows_in_fours(quadratic, flat.dtype) @ squares
    scores += rows_in_fours(linear, flat.dtype) @ flat
    scores = scores[: len(constant)]
    scores += constant.sum(axis=1, keepdims=True).astype(flat.dtype)
    return np.asarray(scores.reshape(-1, *features.shape[1:]))


def mean_probability(
    classifiers: WeakClassifiers, features: FeatureMaps, corners: Floats
) -> float:
    """Mean of p(y = 1 | l_i) over all weak classifiers of all sub-patches, 0..1.

    The paper has no confidence, and its strong classifiers' scores would make a poor one: they
    add log ratios as if the features were independent, and under a change of light a few
    features that fit neither class outweigh all others. Here each has one bounded vote.

    Args:
        classifiers: of Q sub-patches.
        features: (m, rows, columns), normalised.
        corners: p (Q, 2) of the sub-patches, px.
    """
    x, y = nearest_places(corners, features.shape[1:])
    ratios = classifiers.log_ratios(np.asarray(features[:, y, x].T))
    bounded = np.clip(ratios, -_LARGEST_LOG_RATIO, _LARGEST_LOG_RATIO)
    return float((1 / (1 + np.exp(-bounded))).mean())
