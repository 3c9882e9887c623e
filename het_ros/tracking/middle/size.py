# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The target's size: by optical flow from frame to frame, by the scale filter in the long run.

Flow measures how its points spread, and how well that is known: its change counts by
tau^2 / (tau^2 + d^2), with tau the deviation of true changes and d that of the measured one. The
scale filter compares with what was learnt: it corrects what flow says, and replaces it where there
is none, at no more than ``growth_limit``, since it errs in single frames.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.flow import Flow
from het_ros.tracking.features.extractor import Cells
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.middle.scale_filter import ScaleFilter

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SizeConfig:
    """Constants of the size.

    Attributes:
        change: tau, deviation of the logarithm of a true change a frame (measured on the
            sequences of development: the least error over ten frames).
        by_flow: deviation of a measured change over the points' (measured likewise: the points
            of a target are far from independent).
        most_by_flow: largest logarithm a frame (chosen: beyond is no target's growth).
        known_after: frames after which the scale filter is followed in full (chosen).
        smallest: side below which a target is not shrunk, px (chosen: less shows nothing).
    """

    change: float = 0.02
    by_flow: float = 0.35
    most_by_flow: float = 0.1
    known_after: int = 15
    smallest: float = 3.0


class Size:
    """Follows the target's size.

    Args:
        size: (w, h) of the first box, px.
        cells: (w, h) of the target in cells.
        rate: of the scale filter.
        first_frame: share of the first frame in what it learns.
        limit: ``growth_limit``, 1/s.

    Attributes:
        size: (w, h), px.
    """

    def __init__(
        self, size: Floats, cells: Cells, rate: float, first_frame: float, limit: float
    ) -> None:
        self._config = SizeConfig()
        self.size = size
        self._filter = ScaleFilter(cells, rate, first_frame)
        self._limit = limit
        self._frames = 0

    def follow(self, frame: Frame, centre: Floats, flow: Flow | None, dt: float) -> float:
        """Take over the change of size in a frame; returns the ratio to the size before.

        Args:
            frame: the target at its present size.
            centre: (x, y) of the target, cells.
            flow: what optical flow says of it.
            dt: time since the last frame, s.
        """
        config = self._config
        known = min(self._frames / config.known_after, 1.0)
        most = self._limit * dt * known
        by_flow = self._by_flow(flow)
        by_filter = math.log(self._filter.change(frame.stack, centre))
        growth = by_flow + min(max(by_filter - by_flow, -most), most)
        if growth < 0 and self.size.min() * math.exp(growth) < config.smallest:
            growth = 0.0
        ratio = math.exp(growth)
        self.size = self.size * ratio
        return ratio

    def learn(self, frame: Frame, centre: Floats, ratio: float, weight: float) -> None:
        """Learn the target at ``centre``, cells, ``ratio`` times as large as it was looked at."""
        self._frames += 1
        self._filter.learn(frame.stack, centre, ratio, weight)

    def _by_flow(self, flow: Flow | None) -> float:
        """Logarithm of the change that flow is believed."""
        if flow is None:
            return 0.0
        config = self._config
        true, measured = config.change**2, (config.by_flow * flow.deviation) ** 2
        growth = flow.growth * true / (true + measured)
        return min(max(growth, -config.most_by_flow), config.most_by_flow)
