# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Weak classifiers: two Gaussians a compressive feature, compared by naive Bayes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.compressive import FeatureMaps

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Gaussians:
    """Densities N(mu, sigma) of every feature of every sub-patch, eq. (5) "Gaussian".

    Attributes:
        mean: mu (Q, m) float64.
        variance: sigma^2 (Q, m) float64.
    """

    mean: Floats
    variance: Floats


@dataclass(frozen=True)
class WeakClassifiers:
    """m weak classifiers for each of Q sub-patches, eq. (4) "classifier".

    The classes' priors are equal, as in the paper, and drop out.

    Attributes:
        positive: p(l_i | y = 1), the target.
        negative: p(l_i | y = 0), the background.
        sigma_floor: least sigma, in normalised features.
    """

    positive: Gaussians
    negative: Gaussians
    sigma_floor: float

    def coefficients(self) -> tuple[Floats, Floats, Floats]:
        """a, b and c (Q, m) float64 of f(l_i) = a_i l_i^2 + b_i l_i + c_i.

        The log ratio of two Gaussians is quadratic in the feature.
        """
        one, zero = self.positive, self.negative
        variance1 = np.maximum(one.variance, self.sigma_floor**2)
        variance0 = np.maximum(zero.variance, self.sigma_floor**2)
        quadratic = 0.5 / variance0 - 0.5 / variance1
        linear = one.mean / variance1 - zero.mean / variance0
        constant = 0.5 * (
            zero.mean**2 / variance0 - one.mean**2 / variance1 + np.log(variance0 / variance1)
        )
        return quadratic, linear, constant

    def log_ratios(self, features: Floats) -> Floats:
        """f(l_i), eq. (4), for one sample of each sub-patch: (Q, m) of features (Q, m)."""
        quadratic, linear, constant = self.coefficients()
        return np.asarray(quadratic * features**2 + linear * features + constant)


def fit_gaussians(
    features: FeatureMaps, samples: NDArray[np.bool_], scratch: FeatureMaps
) -> Gaussians:
    """Mean and variance of each sub-patch's samples, by one matrix product.

    Args:
        features: (m, rows, columns), normalised.
        samples: (Q, rows, columns), which places are samples of which sub-patch; one at least.
        scratch: of the features' dtype, for twice as many numbers or more; it is written.
    """
    powers = scratch[: 2 * features.size].reshape(2, *features.shape)
    powers[0] = features
    np.multiply(powers[0], powers[0], out=powers[1])
    chosen = samples.reshape(len(samples), -1)
    share = rows_in_fours(chosen / chosen.sum(axis=1, keepdims=True), features.dtype)
    moments = (share @ powers.reshape(2 * len(features), -1).T).astype(np.float64)
    mean, square = np.split(moments[: len(chosen)], 2, axis=1)
    return Gaussians(mean, np.maximum(square - mean**2, 0))


def rows_in_fours(matrix: Floats, dtype: Any) -> FeatureMaps:
    """A matrix of a dtype, with rows of zeros up to a multiple of 4: BLAS multiplies it faster."""
    padded = np.zeros((-(-len(matrix) // 4) * 4, matrix.shape[1]), dtype)
    padded[: len(matrix)] = matrix
    return padded
