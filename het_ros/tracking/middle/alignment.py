# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Template alignment to the first frame, against drift.

Whatever learns from its own boxes drifts with them. The first box alone was given, so as long as
the target still looks as it did there, place and size are drawn to where both fit (the drift
correction of Matthews, Ishikawa and Baker, PAMI 2004). The alignment is inverse compositional
(Baker and Matthews, IJCV 2004): with T the first frame's features, J their derivatives by the
place and the logarithm of the size, and x those of this frame, p += (J'J + ridge)^-1 J' (T - x).
The correlation of x and T says how far the result is believed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.middle.grid_means import Floats, Planes, grid_means

Features = NDArray[np.float32]


@dataclass(frozen=True)
class AlignmentConfig:
    """Constants of the alignment; chosen, but where it says otherwise.

    Attributes:
        grid: rectangles across and down.
        noise: gray values added to a channel's deviation: what is flat says nothing.
        step: of the derivatives: target sides, and of the logarithm of the size.
        ridge: of the diagonal of J'J.
        steps, settled: at most so many steps, and none shorter than this.
        farthest: target sides, and logarithm of the size, that an alignment may lead.
        chance, sure: correlations between which an alignment is believed not at all and wholly.
        shift, size: part of it that is taken over in a frame.
    """

    grid: tuple[int, int] = (8, 8)
    noise: float = 3.0
    step: float = 0.04
    ridge: float = 0.05
    steps: int = 3
    settled: float = 0.005
    farthest: float = 0.3
    chance: float = 0.25
    sure: float = 0.6
    shift: float = 0.5
    size: float = 0.1


@dataclass(frozen=True)
class Correction:
    """What an alignment says of a place.

    Attributes:
        shift: (x, y), cells, by which it is to be moved.
        growth: logarithm of the ratio by which the size is to be changed.
    """

    shift: Floats
    growth: float


class FirstFrameAlignment:
    """The first frame's features of a target, and how they change with place and size.

    Args:
        planes: C channels (H, W) uint8 of the first frame.
        centre: (x, y) of the target, cells.
        size: (w, h) of the target, cells.
    """

    def __init__(self, planes: Planes, centre: Floats, size: tuple[int, int]) -> None:
        config = self._config = AlignmentConfig()
        self._size = np.array(size, np.float64)
        unit = config.step * np.eye(3)
        looks = self._features(planes, centre, np.concatenate([np.zeros((1, 3)), unit, -unit]))
        derivatives = (looks[1:4] - looks[4:]) / (2 * config.step)  # J' (3, d)
        normal = derivatives @ derivatives.T
        # The constant is for a target without any contrast, which leads nowhere.
        normal[np.diag_indices(3)] += config.ridge * normal.diagonal() + 1e-6
        self._first = looks[0]  # T (d,)
        self._to_step = np.linalg.solve(normal, derivatives)

    def correction(self, planes: Planes, centre: Floats) -> Correction:
        """What is to be changed of a target that was found at ``centre`` (x, y), cells.

        Args:
            planes: C channels (H, W) uint8 of a frame that shows the target at its present size.
            centre: cells.
        """
        config = self._config
        moved = np.zeros(3)
        look = self._features(planes, centre, moved[None])[0]
        before = self._correlation(look)
        for _ in range(config.steps):
            step = self._to_step @ (self._first - look)
            if np.abs(step).max() < config.settled:
                break
            moved = np.clip(moved + step, -config.farthest, config.farthest)
            look = self._features(planes, centre, moved[None])[0]
        alike = self._correlation(look)
        if alike < before:
            return Correction(np.zeros(2), 0.0)
        belief = min(max((alike - config.chance) / (config.sure - config.chance), 0.0), 1.0)
        shift = config.shift * belief * moved[:2] * self._size
        return Correction(shift, config.size * belief * float(moved[2]))

    def _features(self, planes: Planes, centre: Floats, moved: Floats) -> Features:
        """(S, d): each channel's means over a grid, of mean 0 and deviation 1.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, cells.
            moved: (S, 3), target sides and logarithms of the size by which it is looked at beside.
        """
        across, down = self._config.grid
        sides = np.exp(moved[:, 2:]) * self._size
        means = grid_means(planes, centre + moved[:, :2] * self._size, sides, (across, down))
        looks = means.transpose(0, 2, 1, 3).reshape(len(moved), -1, across * down)
        looks = looks - looks.mean(axis=2, keepdims=True)
        looks /= looks.std(axis=2, keepdims=True) + np.float32(self._config.noise)
        return np.asarray(looks.reshape(len(moved), -1))

    def _correlation(self, look: Features) -> float:
        """Of features (d,) with the first frame's, -1..1."""
        energy = float(look @ look) * float(self._first @ self._first)
        return float(look @ self._first) / math.sqrt(max(energy, 1e-12))
