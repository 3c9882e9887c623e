# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's "Model Update": which sub-patches are learnt, from which samples, and how."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.buffers import Buffers
from het_ros.tracking.features.compressive import FeatureMaps
from het_ros.tracking.paper.detection import squared_distances
from het_ros.tracking.paper.weak_classifiers import Gaussians, WeakClassifiers, fit_gaussians

Floats = NDArray[np.float64]
Choice = NDArray[np.bool_]


def to_be_updated(scores: Floats) -> Choice:
    """Which sub-patches to update: scores within mu_c +- sigma_c, eq. (17) "patchUpdate".

    Those far above are left alone as well as those far below. Where all scores are the same the
    open interval is empty and none stands out: then all are updated.

    Args:
        scores: c_new (Q,), raw scores of the re-extracted sub-patches.

    Returns:
        (Q,) bool.
    """
    spread = scores.std()
    if spread == 0:
        return np.ones(scores.shape, bool)
    return np.asarray(np.abs(scores - scores.mean()) < spread)


def class_gaussians(
    features: FeatureMaps,
    corners: Floats,
    positive_radius: float,
    negative_radius: float,
    scratch: Buffers,
) -> tuple[Gaussians, Gaussians]:
    """This frame's positive and negative samples of each sub-patch, as Gaussians.

    Positives are all places within their radius, or the nearest one. Negatives are every second
    place in x and in y from their radius on, or the farthest one.

    Args:
        features: (m, rows, columns), normalised.
        corners: p (Q, 2) of the re-extracted sub-patches, px.
        positive_radius: px.
        negative_radius: px.
        scratch: where the samples are put.
    """
    rows, columns = features.shape[1:]
    low = np.floor(corners.min(axis=0) - positive_radius)
    high = np.ceil(corners.max(axis=0) + positive_radius)
    (x0, y0), (x1, y1) = (np.clip(v, 0, [columns - 1, rows - 1]).astype(int) for v in (low, high))
    near = features[:, y0 : y1 + 1, x0 : x1 + 1]
    distances = squared_distances(corners - [x0, y0], near.shape[1:])
    nearest = distances.min(axis=(1, 2), keepdims=True)
    positive = distances < np.maximum(positive_radius**2, nearest + 1e-9)

    coarse = features[:, ::2, ::2]
    distances = 4 * squared_distances(corners / 2, coarse.shape[1:])
    farthest = distances.max(axis=(1, 2), keepdims=True)
    negative = distances >= np.minimum(negative_radius**2, farthest)
    powers = scratch.empty((2 * max(near.size, coarse.size),), features.dtype)
    return fit_gaussians(near, positive, powers), fit_gaussians(coarse, negative, powers)


def blended(old: Gaussians, new: Gaussians, learning_rate: float, chosen: Choice) -> Gaussians:
    """The Gaussians with the ``chosen`` sub-patches updated, eq. (18) "parameterUpdate".

    Args:
        old: of all frames before.
        new: of this frame's samples.
        learning_rate: weight of the new ones, 1 - lambda.
        chosen: (Q,), which sub-patches.
    """
    keep = 1 - learning_rate  # the paper's lambda
    mean = keep * old.mean + (1 - keep) * new.mean
    variance = (
        keep * old.variance
        + (1 - keep) * new.variance
        + keep * (1 - keep) * (old.mean - new.mean) ** 2
    )
    rows = chosen[:, None]
    return Gaussians(np.where(rows, mean, old.mean), np.where(rows, variance, old.variance))


def updated(
    classifiers: WeakClassifiers,
    positive: Gaussians,
    negative: Gaussians,
    learning_rate: float,
    chosen: Choice,
) -> WeakClassifiers:
    """The weak classifiers with both classes of the ``chosen`` sub-patches updated, eq. (18).

    Args:
        classifiers: of all frames before.
        positive: of this frame's positive samples.
        negative: of its negative ones.
        learning_rate: weight of the new frame, 1 - lambda.
        chosen: (Q,), which sub-patches.
    """
    return WeakClassifiers(
        blended(classifiers.positive, positive, learning_rate, chosen),
        blended(classifiers.negative, negative, learning_rate, chosen),
        classifiers.sigma_floor,
    )
