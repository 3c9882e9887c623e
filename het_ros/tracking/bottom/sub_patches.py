# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The sub-patches of a target as base ensembles: each learns its own look, all vote together."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.ensemble import Look, Plane
from het_ros.tracking.bottom.ridge import RidgeRegression
from het_ros.tracking.box import Box
from het_ros.tracking.features.compressive import FeatureMaps

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Layout:
    """Where the sub-patches lie in their target.

    Attributes:
        size: (w, h) of every sub-patch, cells.
        offsets: (Q, 2) int, dp: corner of a sub-patch relative to the target's, cells.
    """

    size: tuple[int, int]
    offsets: NDArray[np.intp]

    def places(self, maps: tuple[int, ...], target: tuple[int, int]) -> tuple[int, int]:
        """(rows, columns) of the target's corner for which all sub-patches lie in their maps.

        Args:
            maps: (rows, columns) of the sub-patches' feature maps.
            target: (w, h), cells.
        """
        return maps[0] - (target[1] - self.size[1]), maps[1] - (target[0] - self.size[0])


def draw_layout(
    target: tuple[int, int], count: int, fraction: float, rng: np.random.Generator
) -> Layout:
    """Lay out ``count`` sub-patches at random inside a target.

    Args:
        target: (w, h), cells.
        count: Q.
        fraction: side of a sub-patch over the target's.
        rng: where the offsets are drawn from, uniformly among those inside the target.
    """
    width, height = (max(1, round(fraction * side)) for side in target)
    room = [max(0, target[0] - width), max(0, target[1] - height)]
    offsets = rng.integers(0, room, size=(count, 2), endpoint=True)
    return Layout((width, height), offsets.astype(np.intp))


class SubPatchEnsembles:
    """Q base ensembles by ridge regression on common feature maps.

    Args:
        layout: of the sub-patches.
        target: (w, h), cells.
        rates: of the regression, slow to fast.
        ridge: its regularisation.
        first_frame: share of the first frame in what is learnt.

    Attributes:
        layout: as given.
        scores: (Q, rows, columns) of the last vote.
    """

    def __init__(
        self,
        layout: Layout,
        target: tuple[int, int],
        rates: tuple[float, ...],
        ridge: float,
        first_frame: float,
    ) -> None:
        self.layout = layout
        side = math.sqrt(target[0] * target[1])
        self._regression = RidgeRegression(rates, ridge, side, first_frame)
        self.scores: FeatureMaps = np.empty((0, 0, 0), np.float32)

    def vote(self, look: Look) -> Plane:
        """Mean of the sub-patches' scores for each place of the target, about 1 on it.

        The score map of each sub-patch is moved back by its offset dp, so that a place which most
        find likely wins over one that a few find best.
        """
        self.scores = self._regression.score_maps(look.frame.features)
        rows, columns = look.places
        total = np.zeros(look.places, np.float32)
        for one, (x, y) in zip(self.scores, self.layout.offsets.tolist(), strict=True):
            total += one[y : y + rows, x : x + columns]
        total /= len(self.scores)
        return total

    def scores_at(self, row: int, column: int) -> Floats:
        """(Q,) the sub-patches' scores of the last vote for a target with its corner there."""
        x, y = self.layout.offsets.T
        found = self.scores[np.arange(len(x)), row + y, column + x]
        return np.asarray(found, np.float64)

    def learn(self, look: Look, box: Box, weight: float) -> None:
        """Take in the target in ``box``, image px; see :class:`BaseEnsemble`."""
        if weight > 0:
            corners = look.corner_of(np.array(box.centre)) + self.layout.offsets
            self._regression.learn(look.frame.features, corners, weight)

    def forget(self) -> None:
        """Nothing of one frame is kept."""
