# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bottom layer, discriminative: base ensembles by ridge regression on the same feature maps.

Where naive Bayes gives each weak classifier a vote of its own, here the votes are fitted
together: the m features of a place are regressed on a Gaussian label that is 1 at the sub-patch's
own place and falls to 0 around it, a_q = (G + ridge I)^-1 b_q. All sub-patches see the same places
of the window, so they share one Gram matrix, and each other's places are their negatives.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.base_ensembles import nearest_places

Floats = NDArray[np.float64]
Features = NDArray[np.floating[Any]]


# A single frame is a poor sample of a target: of the first frames after it, the n-th is learnt
# _EARLY / (n + _AFTER) times as fast as later ones, until that is 1.
_EARLY, _AFTER = 33, 10


class RidgeEnsembles:
    """Linear base ensembles F_q(l) = a_q . [l, 1], fitted in closed form.

    Args:
        learning_rate: weight of the new frame in the running statistics, 0..1; of the frames
            soon after the first it is more.
        ridge: regularisation, in units of a standardised feature's variance.
        label_sigma: (in x, in y) deviation of the Gaussian labels, px of the maps.
        emphasis: a place weighs 1 + ``emphasis`` times its largest label. There are thousands
            of background places and a handful of the target's; without it the background wins.
        first_frame: share of the first frame that every new frame is mixed with, 0..1, so that
            it is never forgotten: what covers the target for long is learnt bit by bit, but does
            not become the target.
    """

    def __init__(
        self,
        learning_rate: float,
        ridge: float,
        label_sigma: tuple[float, float],
        emphasis: float,
        first_frame: float = 0.0,
    ) -> None:
        self._learning_rate = learning_rate
        self._ridge = ridge
        self._label_sigma = label_sigma
        self._emphasis = emphasis
        self._first_frame = first_frame
        self._frames = 0  # learnt after the first
        self._first: tuple[Features, Features] | None = None  # Gram matrix and moments
        self._gram: Features = np.empty((0, 0))  # (m + 1, m + 1)
        self._moment: Features = np.empty((0, 0))  # (m + 1, Q)
        self._votes: Features = np.empty((0, 0))  # (m + 1, Q)
        self._rows: Features = np.empty((0, 0))  # (m + 1 + Q, places), used again

    @property
    def votes(self) -> Features:
        """(m + 1, Q): a_q, one column a sub-patch, that of the constant 1 last.

        Raises:
            RuntimeError: nothing was learnt.
        """
        if self._first is None:
            raise RuntimeError("the base ensembles know no target yet: call learn first")
        return self._votes

    def score_maps(self, features: Features) -> Features:
        """F_q at every place: (Q, rows, columns), about 1 on the target and 0 elsewhere.

        Args:
            features: (m, rows, columns), standardised.
        """
        votes = self.votes
        flat = features.reshape(len(features), -1)
        scores = votes[:-1].T @ flat
        scores += votes[-1][:, None]
        return np.asarray(scores.reshape(-1, *features.shape[1:]))

    def learn(self, features: Features, corners: Floats, chosen: NDArray[np.bool_]) -> None:
        """Blend this frame into the statistics and fit again; the first call sets them outright.

        Args:
            features: (m, rows, columns), standardised.
            corners: (Q, 2) of the re-extracted sub-patches, px of the maps.
            chosen: (Q,), sub-patches whose labels are taken; the Gram matrix is common to all.
        """
        gram, moment = self._statistics(features, corners)
        if self._first is None:
            self._first = gram, moment
            self._gram, self._moment = gram.copy(), moment.copy()
        else:
            self._frames += 1
            early = max(1, _EARLY / (self._frames + _AFTER))
            rate = min(1, early * self._learning_rate)
            fresh = rate * (1 - self._first_frame)
            first_gram, first_moment = self._first
            self._gram *= 1 - rate
            self._gram += fresh * gram
            self._gram += (rate - fresh) * first_gram
            mixed = fresh * moment + (rate - fresh) * first_moment
            self._moment[:, chosen] *= 1 - rate
            self._moment[:, chosen] += mixed[:, chosen]
        regular = self._gram.copy()
        regular.ravel()[:: len(regular) + 1] += self._ridge
        self._votes = solved(regular, self._moment)

    def likelihood(self, features: Features, corners: Floats) -> float:
        """Mean score of the sub-patches at ``corners`` (Q, 2), cut to 0..1."""
        votes = self.votes
        x, y = nearest_places(corners, features.shape[1:])
        values = (votes[:-1] * features[:, y, x]).sum(axis=0) + votes[-1]
        return float(np.clip(values.mean(), 0, 1))

    def labels(self, corners: Floats, shape: tuple[int, ...], dtype: Any = float) -> Features:
        """Gaussian labels (Q, rows * columns) of the sub-patches at ``corners`` (Q, 2)."""
        labels = np.empty((len(corners), shape[0] * shape[1]), dtype)
        self._write_labels(corners, shape, labels)
        return labels

    def _write_labels(self, corners: Floats, shape: tuple[int, ...], out: Features) -> None:
        sigma_x, sigma_y = self._label_sigma
        across = np.exp(-0.5 * ((np.arange(shape[1]) - corners[:, :1]) / sigma_x) ** 2)
        down = np.exp(-0.5 * ((np.arange(shape[0]) - corners[:, 1:]) / sigma_y) ** 2)
        np.multiply(
            down.astype(out.dtype)[:, :, None],
            across.astype(out.dtype)[:, None, :],
            out=out.reshape(len(corners), *shape),
        )

    def _statistics(self, features: Features, corners: Floats) -> tuple[Features, Features]:
        """Weighted Gram matrix (m + 1, m + 1) and moments (m + 1, Q) with a constant 1 as feature.

        One product of a matrix with itself, of which BLAS computes half: its rows are the
        features, the constant and the labels, all times the root of the weights.
        """
        m = len(features)
        flat = features.reshape(m, -1)
        shape = (m + 1 + len(corners), flat.shape[1])
        if self._rows.shape != shape or self._rows.dtype != flat.dtype:
            self._rows = np.empty(shape, flat.dtype)
        labels = self._rows[m + 1 :]
        self._write_labels(corners, features.shape[1:], labels)
        weights = 1 + self._emphasis * labels.max(axis=0)
        weights /= weights.sum()
        root = np.sqrt(weights, out=self._rows[m])
        np.multiply(flat, root, out=self._rows[:m])
        labels *= root
        products = self._rows @ self._rows.T
        return products[: m + 1, : m + 1].copy(), products[: m + 1, m + 1 :].copy()


def solved(matrix: Features, wanted: Features) -> Features:
    """The solution of ``matrix`` (n, n), symmetric and positive, times x = ``wanted`` (n, Q)."""
    found, votes = cv2.solve(matrix, wanted, flags=cv2.DECOMP_CHOLESKY)
    if not found:
        # Rounding may make the least eigenvalues negative where the regularisation is tiny
        # beside the features: those of a target that was flat when it was started.
        votes = np.linalg.lstsq(matrix, wanted, rcond=None)[0]
    return np.asarray(votes)
