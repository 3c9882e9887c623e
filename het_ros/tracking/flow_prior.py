# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What optical flow adds to the votes: places where the target's own pixels went weigh more."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.flow import Flow, Sight, trace
from het_ros.tracking.gray import gray_of
from het_ros.tracking.window import Window

Floats = NDArray[np.float64]
Prior = NDArray[np.float32]

_SIGMA = 0.12  # target sides, how exact flow is
_AFTER = 1.0  # s in sight: just back, flow would go with who passes in front
_TRUSTED = 0.5  # score of the last frame from which on flow counts in full
_SHARE = 0.2  # of the points: fewer that agree say nothing


class FlowPrior:
    """Remembers the target of the last frame and says where flow finds it in this one.

    Args:
        config: parameters.
        cells: (w, h) of the target in cells.
    """

    def __init__(self, config: TrackerConfig, cells: tuple[float, float]) -> None:
        self._weight = config.flow_weight
        self._cell = config.cell
        self._side = math.sqrt(cells[0] * cells[1])
        self._before: Sight | None = None
        self._trusted = 1.0
        self._in_sight_for = math.inf

    def over(
        self, window: Window, expected: Floats, shape: tuple[int, int], middle: Floats
    ) -> Prior:
        """What a place's vote is multiplied by: (rows, columns) float32, 1 and more.

        It multiplies: a post that slides over the target moves smoothly too, but does not look
        like it.

        Args:
            window: this frame's search window, its places in cells.
            expected: (x, y) of the target by the motion model, image px; flow starts there.
            shape: (rows, columns) of the places.
            middle: (x, y), cells, from a place to the centre of a target there.
        """
        flow = self._flow(window, expected)
        if flow is None:
            return np.ones(shape, np.float32)
        place = window.to_window(flow.centre) - middle
        sigma = _SIGMA * self._side
        down = np.exp(-0.5 * ((np.arange(shape[0]) - place[1]) / sigma) ** 2)
        across = np.exp(-0.5 * ((np.arange(shape[1]) - place[0]) / sigma) ** 2)
        weight = self._weight * self._trusted * flow.share
        return np.asarray(1 + weight * np.outer(down, across), np.float32)

    def remember(self, window: Window, box: Box, dt: float, score: float = 1.0) -> None:
        """The target is in sight, ``dt`` s after the last frame.

        It is in ``box``, image px, which is turned around its centre as the window is.
        The lower the ``score`` of that, the less its pixels say: they may be a post's that slides
        over it.
        """
        self._trusted = min(1.0, score / _TRUSTED)
        self._in_sight_for += dt
        if self._weight and self._in_sight_for > _AFTER:
            self._before = Sight(self._in_px(window), gray_of(window.pixels), box)

    def forget(self) -> None:
        """The target is hidden."""
        self._in_sight_for = 0.0
        self._before = None

    def _flow(self, window: Window, expected: Floats) -> Flow | None:
        if self._before is None:
            return None
        moved = expected - np.array(self._before.box.centre)
        flow = trace(self._before, self._in_px(window), gray_of(window.pixels), moved)
        return flow if flow and flow.share > _SHARE else None

    def _in_px(self, window: Window) -> Window:
        """A window in cells with its places counted in px."""
        return window.in_cells(1 / self._cell)
