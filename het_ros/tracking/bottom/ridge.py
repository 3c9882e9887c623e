# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ridge regression of the sub-patches on compressive features.

Where naive Bayes gives each weak classifier a vote of its own, here the votes are fitted
together: the m features of a place are regressed on a Gaussian label that is 1 at the sub-patch's
own place and falls to 0 around it, a_q = (G + ridge I)^-1 b_q. All sub-patches see the same places
of the window, so they share one Gram matrix, and each other's places are their negatives.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.buffers import Buffers
from het_ros.tracking.features.compressive import FeatureMaps

Floats = NDArray[np.float64]
_Statistics = tuple[FeatureMaps, FeatureMaps]


@dataclass(frozen=True)
class RidgeConfig:
    """Constants of the regression.

    Attributes:
        label_sigma: deviation of the labels, target sides (chosen: the peak is as wide as a box
            may be off with an overlap of 0.8).
        emphasis: a place weighs 1 + this times its largest label (chosen: there are thousands of
            background places and a handful of the target's).
        early, after: of the first frames the n-th is learnt early / (n + after) times as fast
            (chosen: a single frame is a poor sample of a target).
    """

    label_sigma: float = 0.12
    emphasis: float = 20.0
    early: float = 33.0
    after: float = 10.0


class RidgeRegression:
    """Linear scores F_q(l) = a_q . [l, 1], fitted in closed form at several rates.

    The mean of the fits votes: what was learnt fast knows today's target, what was learnt slowly
    knows what it looks like in general.

    Args:
        rates: weight of the new frame in the running statistics, one a fit.
        ridge: regularisation, in units of a normalised feature's variance.
        side: sqrt(w h) of the target, cells.
        first_frame: share of the first frame that every new frame is mixed with, 0..1; the last
            fit, the fastest, goes without.
    """

    def __init__(
        self, rates: tuple[float, ...], ridge: float, side: float, first_frame: float
    ) -> None:
        self._config = RidgeConfig()
        self._rates, self._ridge, self._first_frame = rates, ridge, first_frame
        self._sigma = self._config.label_sigma * side
        self._buffers = Buffers()
        self._learnt = 0  # frames after the first, in units of whole ones
        self._first: _Statistics | None = None
        self._running: list[_Statistics] = []
        self._fits: list[FeatureMaps] = []

    @property
    def weights(self) -> FeatureMaps:
        """(m + 1, Q): mean of the fits a_q, one column a sub-patch, that of the constant last.

        Raises:
            RuntimeError: nothing was learnt.
        """
        if not self._fits:
            raise RuntimeError("the regression knows no target yet: call learn first")
        return np.asarray(sum(self._fits[1:], self._fits[0]) / np.float32(len(self._fits)))

    def score_maps(self, features: FeatureMaps) -> FeatureMaps:
        """F_q at every place: (Q, rows, columns), about 1 on the target and 0 elsewhere.

        Args:
            features: (m, rows, columns), normalised.
        """
        weights = self.weights
        scores = weights[:-1].T @ features.reshape(len(features), -1)
        scores += weights[-1][:, None]
        return np.asarray(scores.reshape(-1, *features.shape[1:]))

    def learn(self, features: FeatureMaps, corners: Floats, weight: float) -> None:
        """Blend a frame into the statistics and fit again; the first call sets them outright.

        Args:
            features: (m, rows, columns), normalised.
            corners: (Q, 2) of the sub-patches, cells.
            weight: 0..1, of this frame.
        """
        frame = self._statistics(features, corners)
        if self._first is None:
            self._first = frame
            self._running = [frame] * len(self._rates)
        else:
            self._learnt += 1
            config = self._config
            early = max(1.0, config.early / (self._learnt + config.after))
            for k, base in enumerate(self._rates):
                rate = min(1.0, early * base * weight)
                of_first = self._first_frame if k == 0 else 0.0
                self._running[k] = _blended(self._running[k], frame, self._first, rate, of_first)
        self._fits = [self._solved(*statistics) for statistics in self._running]

    def _solved(self, gram: FeatureMaps, moment: FeatureMaps) -> FeatureMaps:
        regular = gram.copy()
        regular.ravel()[:: len(regular) + 1] += self._ridge
        return solved(regular, moment)

    def _statistics(self, features: FeatureMaps, corners: Floats) -> _Statistics:
        """Weighted Gram matrix (m + 1, m + 1) and moments (m + 1, Q) with a constant 1 as feature.

        One product of a matrix with itself, of which BLAS computes half: its rows are the
        features, the constant and the labels, all times the root of the weights.
        """
        m = len(features)
        flat = features.reshape(m, -1)
        rows = self._buffers.empty((m + 1 + len(corners), flat.shape[1]), flat.dtype)
        labels = rows[m + 1 :]
        labels[:] = self.labels(corners, features.shape[1:])
        weights = 1 + self._config.emphasis * labels.max(axis=0)
        weights /= weights.sum()
        root = np.sqrt(weights, out=rows[m])
        np.multiply(flat, root, out=rows[:m])
        labels *= root
        products = rows @ rows.T
        return products[: m + 1, : m + 1].copy(), products[: m + 1, m + 1 :].copy()

    def labels(self, corners: Floats, shape: tuple[int, ...]) -> FeatureMaps:
        """Gaussian labels (Q, rows * columns) float32 of the sub-patches at ``corners`` (Q, 2)."""
        across = np.exp(-0.5 * ((np.arange(shape[1]) - corners[:, :1]) / self._sigma) ** 2)
        down = np.exp(-0.5 * ((np.arange(shape[0]) - corners[:, 1:]) / self._sigma) ** 2)
        labels = down.astype(np.float32)[:, :, None] * across.astype(np.float32)[:, None, :]
        return np.asarray(labels.reshape(len(corners), -1))


def _blended(
    running: _Statistics, frame: _Statistics, first: _Statistics, rate: float, of_first: float
) -> _Statistics:
    """(1 - rate) running + rate ((1 - of_first) frame + of_first first), of both arrays."""
    kept, fresh, old = 1 - rate, rate * (1 - of_first), rate * of_first
    gram, moment = (
        np.asarray(kept * r + fresh * f + (old * o if old else 0.0))
        for r, f, o in zip(running, frame, first, strict=True)
    )
    return gram, moment


def solved(matrix: NDArray[Any], wanted: NDArray[Any]) -> FeatureMaps:
    """The solution of ``matrix`` (n, n), symmetric and positive, times x = ``wanted`` (n, Q)."""
    found, solution = cv2.solve(matrix, wanted, flags=cv2.DECOMP_CHOLESKY)
    if not found:
        # Rounding may make the least eigenvalues negative where the regularisation is tiny
        # beside the features: those of a target that was flat when it was started.
        solution = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    return np.asarray(solution)
