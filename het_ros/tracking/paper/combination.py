# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Middle layer: from the detected sub-patches to one measurement of the target."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def hypotheses(corners: Floats, offsets: Floats) -> Floats:
    """Each sub-patch's hypothesis y_i of the target's corner, eq. (8) "error".

    The paper writes y_i = dp_i + p_i. With dp_i the sub-patch's corner relative to the target's
    it must be p_i - dp_i, as here.

    Args:
        corners: p (Q, 2), where the sub-patches were found, px.
        offsets: dp (Q, 2), px.

    Returns:
        (Q, 2), px.
    """
    return corners - offsets


def weights(scores: Floats, low: float, high: float) -> Floats:
    """Weights omega (Q,) in [low, high]: scores to zero mean and unit deviation, then rescaled.

    The best sub-patch gets ``high`` and the worst ``low`` in every frame, so the mean of the
    weights says how the others lie between them and not whether the target is there. Equal
    scores give every sub-patch the middle of the range.

    Args:
        scores: c (Q,), raw scores.
        low: weight of the worst sub-patch.
        high: weight of the best one.
    """
    deviation = scores.std()
    # Scores that differ by rounding alone are equal.
    if deviation <= 1e-12 * np.abs(scores).max():
        return np.full(scores.shape, (low + high) / 2)
    normalised = (scores - scores.mean()) / deviation
    least, most = normalised.min(), normalised.max()
    return np.asarray(low + (high - low) * (normalised - least) / (most - least))


def combine(candidates: Floats, omega: Floats) -> Floats:
    """Weighted mean y_COM (2,) of the hypotheses (Q, 2), eq. (9) "weightAverage"."""
    return np.asarray(omega @ candidates / omega.sum())


def squared_errors(candidates: Floats, target: Floats) -> Floats:
    """Squared errors (Q,) of the hypotheses, px^2, eq. (10) "sum-of-squares error".

    Args:
        candidates: y (Q, 2), px.
        target: H (2,), px. y_COM in place of the unknown truth gives the hypotheses' spread.
    """
    return np.asarray(((candidates - target) ** 2).sum(axis=1))


def average_error(candidates: Floats, omega: Floats, target: Floats) -> float:
    """E_AV, px^2: mean error of the hypotheses by themselves, eq. (11) "average error".

    Args:
        candidates: y (Q, 2), px.
        omega: weights (Q,).
        target: H (2,), px.
    """
    return float(omega @ squared_errors(candidates, target) / omega.sum())


def combined_error(candidates: Floats, omega: Floats, target: Floats) -> float:
    """E_COM, px^2: error of the combination, eq. (13) "expected error".

    Under eq. (12) "assume", errors of zero mean that are uncorrelated, it is
    sum(omega_i^2 e_i^2) / W^2: at most E_AV / W, since no weight exceeds 1. Arguments as for
    :func:`average_error`.
    """
    return float(omega**2 @ squared_errors(candidates, target) / omega.sum() ** 2)
