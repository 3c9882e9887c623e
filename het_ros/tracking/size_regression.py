# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A second opinion on the target's size: ridge regression of its logarithm.

A correlation filter over sizes (``scale``) takes each feature for itself. Here all of them are
regressed together on the logarithm of how much too small they were looked at:
b = (G + lambda mean(diag G) I)^-1 c, with G the Gram matrix of the features and c their products
with the wanted answers. The samples of a frame are the target at five sizes, and beside its place,
where the answer is 0: what changes from frame to frame, and what a place that is not exact does,
is learnt not to matter. The errors of both opinions have little in common, so that their mean is
better than each.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.grid_means import Features, Floats, Planes, Standard, grid_means
from het_ros.tracking.memory import Memory
from het_ros.tracking.ridge import solved

_GRID = 5, 5  # rectangles across and down
_RIDGE = 3.0  # lambda
_SIZES = np.array([-0.1, -0.05, 0.05, 0.1])  # logarithms, looked at beside the true one
_BESIDE = 0.04  # sides of what is looked at: how far beside the target its size is looked at
_EVERY = 2  # frames: to learn one costs more than all else about the size
_AS_IT_IS = 10.0  # weight of the target at its place and size

_SHIFTS = np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y])
# Samples of a frame: (S,) logarithms of their sizes, (S, 2) sides from the target's centre.
_LOGARITHMS = np.concatenate([[0.0], _SIZES, np.zeros(len(_SHIFTS))])
_PLACES = np.concatenate([np.zeros((1 + len(_SIZES), 2)), _BESIDE * _SHIFTS])
_WEIGHTS = np.concatenate([[_AS_IT_IS], np.ones(len(_LOGARITHMS) - 1)])
_WEIGHTS /= _WEIGHTS.sum()


class SizeRegression:
    """Finds the target's change of size and learns from where it was found.

    Args:
        size: (w, h) of the target at the present size, px of the channels.
        context: how much more than the target is looked at.
        learning_rate: weight of a frame, 0..1; every second one is learnt, at twice the rate.
        first_frame: share of the first frame in what is learnt, which is never forgotten, 0..1.
    """

    def __init__(
        self, size: tuple[int, int], context: float, learning_rate: float, first_frame: float
    ) -> None:
        self._size = np.array(size, np.float64) * context
        # G (d + 1, d + 1), c (d + 1, 1)
        self._memory = Memory(min(1.0, _EVERY * learning_rate), first_frame)
        self._frames = 0
        self._standard = Standard()
        self._coefficients: NDArray[np.floating] = np.empty(0)  # b (d + 1,)

    def change(self, planes: Planes, centre: Floats) -> float:
        """Ratio of the target's size in this frame to the present size.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.

        Raises:
            RuntimeError: nothing was learnt.
        """
        if not self._memory:
            raise RuntimeError("no size is known yet: call learn first")
        features = self._features(planes, centre, self._size[None])
        return math.exp(float(features[0] @ self._coefficients))

    def learn(self, planes: Planes, centre: Floats, ratio: float) -> None:
        """Learn the target at ``centre``, ``ratio`` times the present size, if it is due.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.
            ratio: of the size that it has to the present one.
        """
        self._frames += 1
        if self._frames % _EVERY == 0:
            return
        sides = ratio * np.exp(_LOGARITHMS)[:, None] * self._size
        features = self._features(planes, centre + _PLACES * self._size, sides)
        weighted = _WEIGHTS.astype(np.float32)[:, None] * features
        wanted = -_LOGARITHMS.astype(np.float32)[:, None]
        self._memory.learn(features.T @ weighted, weighted.T @ wanted)
        gram, products = self._memory.values
        regular = gram.copy()
        diagonal = regular.ravel()[: -1 : len(regular) + 1]  # without the constant's
        diagonal += _RIDGE * diagonal.mean()
        self._coefficients = solved(regular, products)[:, 0]

    def _features(self, planes: Planes, centres: Floats, sides: Floats) -> Features:
        """(S, d + 1): channel means over grids, standardised, and a constant 1."""
        means = grid_means(planes, centres, sides, _GRID)  # (S, b, C, a)
        features = np.ones((len(sides), means[0].size + 1), np.float32)
        features[:, :-1] = self._standard.features(means)
        return features
