# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Penalised logistic regression with whole groups held out, and how good its probabilities are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
BINS = 10  # of the probability, for the calibration error
PENALTY = 1.0  # on weights of features of deviation 1 (chosen)
FRAMES = 10.0  # independent frames that a sequence counts as, beside the penalty (chosen)
DECIMALS = 3


@dataclass(frozen=True)
class Examples:
    """Frames to learn from.

    Attributes:
        features: (n, k) float64.
        right: (n,) bool, what is to be told.
        sequences: (n,) str; each weighs the same.
        groups: (n,) str; those of one group are held out together.
    """

    features: Floats
    right: NDArray[np.bool_]
    sequences: NDArray[np.str_]
    groups: NDArray[np.str_]

    def __len__(self) -> int:
        return len(self.right)

    def taken(self, rows: NDArray[np.bool_]) -> Examples:
        """Some of them."""
        columns = self.features, self.right, self.sequences, self.groups
        return Examples(*(column[rows] for column in columns))

    @property
    def weights(self) -> Floats:
        """(n,): those of one sequence add up to ``FRAMES``."""
        _, which, count = np.unique(self.sequences, return_inverse=True, return_counts=True)
        return np.asarray(FRAMES / count[which])


def fit(examples: Examples) -> tuple[float, ...]:
    """Weights of the features and the bias last, rounded.

    The penalty is on features brought to a deviation of 1, the bias is free of it. The same
    examples give the same weights to the bit.

    Raises:
        ValueError: all examples are right, or none.
    """
    from sklearn.linear_model import LogisticRegression  # the extra "fit"
    from sklearn.preprocessing import StandardScaler

    if len(np.unique(examples.right)) < 2:
        raise ValueError("a fit needs frames that are right and frames that are wrong")
    weights = examples.weights
    scaler = StandardScaler().fit(examples.features, sample_weight=weights)
    model = LogisticRegression(C=1 / PENALTY, solver="lbfgs", tol=1e-8, max_iter=1000)
    model.fit(scaler.transform(examples.features), examples.right, sample_weight=weights)
    slopes = model.coef_[0] / scaler.scale_
    bias = float(model.intercept_[0] - (slopes * scaler.mean_).sum())
    return tuple(round(float(value), DECIMALS) + 0.0 for value in (*slopes, bias))


def probabilities(features: Floats, fitted: tuple[float, ...]) -> Floats:
    """(n,): of rows of features, by weights with the bias last."""
    logit = features @ np.array(fitted[:-1]) + fitted[-1]
    return np.asarray(1 / (1 + np.exp(-np.clip(logit, -50, 50))))


def held_out(examples: Examples) -> Floats:
    """(n,): each probability by a fit that has seen no frame of its group.

    Raises:
        ValueError: there are fewer than two groups, or what is left for a fit is all right or
            all wrong.
    """
    groups = np.unique(examples.groups)
    if len(groups) < 2:
        raise ValueError("holding out needs two sequences or more that share no pictures")
    found = np.zeros(len(examples))
    for group in groups:
        out = examples.groups == group
        found[out] = probabilities(examples.features[out], fit(examples.taken(~out)))
    return found


@dataclass(frozen=True)
class Quality:
    """How good probabilities are; each sequence weighs the same.

    Attributes:
        error: mean distance of the bins from the diagonal (expected calibration error).
        roc: area under the ROC curve; NaN where all are right or all wrong.
        bins: (probability, share that is right, share of the weight) of each bin.
    """

    error: float
    roc: float
    bins: tuple[tuple[float, float, float], ...]


def quality(found: Floats, examples: Examples) -> Quality:
    """Of probabilities (n,) of the examples."""
    from sklearn.metrics import roc_auc_score

    weights = examples.weights / examples.weights.sum()
    which = np.minimum((found * BINS).astype(int), BINS - 1)
    bins = []
    for index in np.unique(which):
        inside = which == index
        share = weights[inside].sum()
        said = (weights[inside] * found[inside]).sum() / share
        right = (weights[inside] * examples.right[inside]).sum() / share
        bins.append((float(said), float(right), float(share)))
    both = len(np.unique(examples.right)) == 2
    roc = roc_auc_score(examples.right, found, sample_weight=weights) if both else np.nan
    error = sum(share * abs(said - right) for said, right, share in bins)
    return Quality(float(error), float(roc), tuple(bins))
