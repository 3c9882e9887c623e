# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bottom layer: the base ensembles that find the sub-patches again.

A sub-patch's base ensemble is the sum of m weak classifiers, one a compressive feature. All of
them are evaluated on the same feature maps at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Features = NDArray[np.floating[Any]]
Indices = NDArray[np.intp]


class BaseEnsembles(Protocol):
    """What the tracker asks of a bottom layer."""

    @property
    def votes(self) -> Features | None:
        """(m + 1, Q) of linear base ensembles: of each feature and of a constant; else None."""
        ...

    def score_maps(self, features: Features) -> Features:
        """Scores (Q, rows, columns) of all sub-patches at all places of (m, rows, columns)."""
        ...

    def learn(self, features: Features, corners: Floats, chosen: NDArray[np.bool_]) -> None:
        """Update the model of the ``chosen`` (Q,) sub-patches, which lie at ``corners`` (Q, 2).

        ``features`` are those that :meth:`score_maps` was last called with, or a first frame's.
        """
        ...

    def likelihood(self, features: Features, corners: Floats) -> float:
        """How target-like the sub-patches at ``corners`` (Q, 2) are, 0..1."""
        ...


@dataclass(frozen=True)
class Detections:
    """Where the sub-patches were found.

    Attributes:
        corners: p (Q, 2) float64, working px.
        scores: c (Q,) float64, raw scores there.
    """

    corners: Floats
    scores: Floats


def detect(scores: Features, corners: Floats, radius: float) -> Detections:
    """Find each sub-patch at its best place within ``radius`` (eq. classification).

    The N samples of the paper are all places of the disc. Of equal scores the one nearest the
    centre counts, so that a target in front of nothing stays where it is.

    Args:
        scores: F (Q, rows, columns) at every working px, rows and columns from 0.
        corners: where the sub-patches are looked for (Q, 2), working px.
        radius: beta, working px; a centre is never without samples.
    """
    distances = squared_distances(corners, scores.shape[1:])
    # The least of a sum of what depends on x alone and on y alone.
    nearest = distances[:, :, :1].min(axis=1) + distances[:, :1].min(axis=2) - distances[:, 0, :1]
    inside = distances < np.maximum(radius**2, nearest + 1e-9)[:, :, None]
    flat = np.where(inside, scores, -np.inf).reshape(len(scores), -1)
    at = flat.argmax(axis=1)
    best = np.take_along_axis(flat, at[:, None], axis=1)
    equal = flat == best
    if np.count_nonzero(equal) > len(equal):
        at = np.where(equal, distances.reshape(flat.shape), np.inf).argmin(axis=1)
    y, x = np.divmod(at, scores.shape[2])
    return Detections(np.stack([x, y], axis=1).astype(np.float64), best[:, 0].astype(np.float64))


def scores_at(scores: Features, corners: Floats) -> Floats:
    """c_new (Q,): each sub-patch's score at the place nearest to its corner (Q, 2), working px."""
    x, y = nearest_places(corners, scores.shape[1:])
    return np.asarray(scores[np.arange(len(scores)), y, x], np.float64)


def nearest_places(corners: Floats, shape: tuple[int, ...]) -> tuple[Indices, Indices]:
    """Columns (Q,) and rows (Q,) of the places nearest to corners (Q, 2), working px."""
    rows, columns = shape
    return (
        np.clip(np.rint(corners[:, 0]).astype(np.intp), 0, columns - 1),
        np.clip(np.rint(corners[:, 1]).astype(np.intp), 0, rows - 1),
    )


def squared_distances(corners: Floats, shape: tuple[int, ...]) -> Floats:
    """(Q, rows, columns): squared distance of each place to each corner (Q, 2), working px^2."""
    rows, columns = shape
    dx = np.arange(columns) - corners[:, :1]
    dy = np.arange(rows) - corners[:, 1:]
    return np.asarray(dy[:, :, None] ** 2 + dx[:, None, :] ** 2)


@dataclass
class Gaussians:
    """Class-conditional densities of every feature for every sub-patch (eq. Gaussian).

    Attributes:
        mean: mu (Q, m) float64.
        variance: sigma^2 (Q, m) float64.
    """

    mean: Floats
    variance: Floats

    def blend(self, new: Gaussians, keep: float, chosen: NDArray[np.bool_]) -> None:
        """Update the ``chosen`` (Q,) sub-patches in place (eq. parameterUpdate).

        Args:
            new: mean and variance of this frame's samples.
            keep: lambda, weight of the old values.
            chosen: which sub-patches.
        """
        mean, variance = self.mean[chosen], self.variance[chosen]
        new_mean, new_variance = new.mean[chosen], new.variance[chosen]
        self.mean[chosen] = keep * mean + (1 - keep) * new_mean
        self.variance[chosen] = (
            keep * variance
            + (1 - keep) * new_variance
            + keep * (1 - keep) * (mean - new_mean) ** 2
        )


class NaiveBayes:
    """Base ensembles of naive Bayes classifiers (eqs. classifier, Gaussian, strongClassifier).

    Args:
        learning_rate: lambda, weight of the old value at an update.
        positive_radius: samples nearer than this to a sub-patch are positives, working px.
        negative_radius: samples at least this far are negatives, working px.
        sigma_floor: least sigma, in standardised features.
    """

    def __init__(
        self,
        learning_rate: float,
        positive_radius: float,
        negative_radius: float,
        sigma_floor: float,
    ) -> None:
        self._learning_rate = learning_rate
        self._positive_radius = positive_radius
        self._negative_radius = negative_radius
        self._least_variance = sigma_floor**2
        self._positive: Gaussians | None = None
        self._negative: Gaussians | None = None
        # Buffers used again: of all places, and of those that samples are taken from.
        self._squares: Features = np.empty((0, 0))
        self._powers: Features = np.empty(0)

    @property
    def votes(self) -> None:
        """None: a Gaussian's vote is not linear."""

    def score_maps(self, features: Features) -> Features:
        """F(l) = sum of f(l_i) (eq. strongClassifier) of every sub-patch at every place.

        The log ratio of two Gaussians is quadratic in the feature, so all of them are one
        matrix product: (Q, 2 m) by (2 m, places), done in two halves to copy nothing.

        Args:
            features: (m, rows, columns), standardised.

        Returns:
            (Q, rows, columns), of the features' dtype.
        """
        quadratic, linear, constant = self.coefficients()
        flat = features.reshape(len(features), -1)
        scores = _in_fours(quadratic, flat.dtype) @ self._squared(flat)
        scores += _in_fours(linear, flat.dtype) @ flat
        scores = scores[: len(constant)]
        scores += constant.sum(axis=1, keepdims=True).astype(flat.dtype)
        return scores.reshape(-1, *features.shape[1:])

    def coefficients(self) -> tuple[Floats, Floats, Floats]:
        """a, b and c (Q, m) of f(l_i) = a_i l_i^2 + b_i l_i + c_i (eq. classifier).

        The classes' priors are equal, as in the paper, and drop out.
        """
        if self._positive is None or self._negative is None:
            raise RuntimeError("the base ensembles know no target yet: call learn first")
        one, zero = self._positive, self._negative
        variance1 = np.maximum(one.variance, self._least_variance)
        variance0 = np.maximum(zero.variance, self._least_variance)
        quadratic = 0.5 / variance0 - 0.5 / variance1
        linear = one.mean / variance1 - zero.mean / variance0
        constant = 0.5 * (
            zero.mean**2 / variance0 - one.mean**2 / variance1 + np.log(variance0 / variance1)
        )
        return quadratic, linear, constant

    def learn(self, features: Features, corners: Floats, chosen: NDArray[np.bool_]) -> None:
        """Update the Gaussians of the ``chosen`` sub-patches; the first call sets them outright.

        Args:
            features: (m, rows, columns), standardised.
            corners: (Q, 2) of the re-extracted sub-patches, working px.
            chosen: (Q,).
        """
        positive, negative = self._class_gaussians(features, corners)
        if self._positive is None or self._negative is None:
            self._positive, self._negative = positive, negative
            return
        self._positive.blend(positive, self._learning_rate, chosen)
        self._negative.blend(negative, self._learning_rate, chosen)

    def likelihood(self, features: Features, corners: Floats) -> float:
        """Mean of p(y = 1 | l_i) over all weak classifiers of all sub-patches.

        The paper has no confidence. The strong classifiers' scores would make a poor one: they
        add log ratios as if the features were independent, and under a change of light a few
        features that fit neither class outweigh all others. Here each has one bounded vote.

        Args:
            features: (m, rows, columns), standardised.
            corners: (Q, 2) of the sub-patches, working px.
        """
        quadratic, linear, constant = self.coefficients()
        x, y = nearest_places(corners, features.shape[1:])
        values = features[:, y, x].T
        log_ratios = quadratic * values**2 + linear * values + constant
        return float((1 / (1 + np.exp(-np.clip(log_ratios, -50, 50)))).mean())

    def _class_gaussians(self, features: Features, corners: Floats) -> tuple[Gaussians, Gaussians]:
        """This frame's positive and negative samples of each sub-patch, as Gaussians.

        Positives are all places within their radius, or the nearest one. Negatives are every
        second place in x and in y from their radius on, or the farthest one.
        """
        rows, columns = features.shape[1:]
        low = np.floor(corners.min(axis=0) - self._positive_radius)
        high = np.ceil(corners.max(axis=0) + self._positive_radius)
        (x0, y0), (x1, y1) = (
            np.clip(v, 0, [columns - 1, rows - 1]).astype(int) for v in (low, high)
        )
        near = features[:, y0 : y1 + 1, x0 : x1 + 1]
        distances = squared_distances(corners - [x0, y0], near.shape[1:])
        nearest = distances.min(axis=(1, 2), keepdims=True)
        positive = distances < np.maximum(self._positive_radius**2, nearest + 1e-9)

        coarse = features[:, ::2, ::2]
        distances = 4 * squared_distances(corners / 2, coarse.shape[1:])
        farthest = distances.max(axis=(1, 2), keepdims=True)
        negative = distances >= np.minimum(self._negative_radius**2, farthest)
        size = 2 * max(near.size, coarse.size)
        if self._powers.size < size or self._powers.dtype != features.dtype:
            self._powers = np.empty(size, features.dtype)
        return (
            sample_gaussians(near, positive, self._powers),
            sample_gaussians(coarse, negative, self._powers),
        )

    def _squared(self, flat: Features) -> Features:
        """The features (m, places) squared, in a buffer used again."""
        if self._squares.shape != flat.shape or self._squares.dtype != flat.dtype:
            self._squares = np.empty_like(flat)
        return np.multiply(flat, flat, out=self._squares)


def sample_gaussians(
    features: Features, samples: NDArray[np.bool_], buffer: Features | None = None
) -> Gaussians:
    """Mean and variance of each sub-patch's samples, by one matrix product.

    Args:
        features: (m, rows, columns), standardised.
        samples: (Q, rows, columns), which places are samples of which sub-patch; one at least.
        buffer: of the features' dtype, for twice as many numbers; it is overwritten.
    """
    if buffer is None:
        buffer = np.empty(2 * features.size, features.dtype)
    powers = buffer[: 2 * features.size].reshape(2, *features.shape)
    powers[0] = features
    np.multiply(powers[0], powers[0], out=powers[1])
    chosen = samples.reshape(len(samples), -1)
    share = _in_fours(chosen / chosen.sum(axis=1, keepdims=True), features.dtype)
    moments = (share @ powers.reshape(2 * len(features), -1).T).astype(np.float64)
    mean, square = np.split(moments[: len(chosen)], 2, axis=1)
    return Gaussians(mean, np.maximum(square - mean**2, 0))


def _in_fours(matrix: Floats, dtype: Any) -> Features:
    """A matrix of a dtype, with rows of zeros up to a multiple of 4: BLAS multiplies it faster."""
    padded = np.zeros((-(-len(matrix) // 4) * 4, matrix.shape[1]), dtype)
    padded[: len(matrix)] = matrix
    return padded
