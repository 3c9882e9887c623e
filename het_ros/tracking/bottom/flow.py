# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where the target's own pixels went since the last frame, and how much they spread.

Score maps say which places look like the target; optical flow (pyramidal Lucas-Kanade) of points
in its box knows where it was a frame ago. Points count where the flow back leads to where they
came from (forward-backward error: Kalal, Mikolajczyk, Matas, ICPR 2010). A line is fitted to where
they went, x' = a + s x, with points far from it counting less: its slope s is the change of size,
and how far points lie from it says how well that is known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.ensemble import Look, Plane
from het_ros.tracking.box import Box
from het_ros.tracking.features.channels import Pixels, gray_of
from het_ros.tracking.features.window import Window

Floats = NDArray[np.float64]
_Points = NDArray[np.float32]


@dataclass(frozen=True)
class FlowConfig:
    """Constants of the flow; chosen, but where it says otherwise.

    Attributes:
        grid, core: points a side, and the part of the box that they lie in.
        patch: side of what is compared around a point, working px.
        levels: of the pyramid above the window itself.
        iterations, settled: a point stops after so many steps or one shorter than this, px.
        least_contrast: least eigenvalue of a point's gradients (OpenCV's unit).
        there_and_back: largest error of the flow back, px.
        together: distance from the median, target sides, beyond which a point is not the target's.
        fewest: points.
        sigma: how exact a place by flow is, target sides.
        least_share: of the points: fewer that agree say nothing of the place.
        trusted: score of the last frame from which on flow counts in full.
    """

    grid: int = 10
    core: float = 0.9
    patch: int = 11
    levels: int = 2
    iterations: int = 8
    settled: float = 0.05
    least_contrast: float = 1e-3
    there_and_back: float = 1.0
    together: float = 0.25
    fewest: int = 10
    sigma: float = 0.12
    least_share: float = 0.2
    trusted: float = 0.5


@dataclass(frozen=True)
class Flow:
    """What optical flow says of a target.

    Attributes:
        shift: (x, y), image px: median way of its points since the last frame.
        centre: (x, y), image px: where its box's centre went with them.
        share: of the points that could be followed and went together, 0..1.
        growth: logarithm of the ratio of its size to that of the last frame.
        deviation: of the points from the fit over their spread: that of ``growth`` for one point.
    """

    shift: Floats
    centre: Floats
    share: float
    growth: float
    deviation: float


@dataclass(frozen=True)
class _Seen:
    """A target in a frame: window (places in working px), gray pixels, box."""

    window: Window
    gray: Pixels
    box: Box


class FlowEnsemble:
    """Remembers the target of the last frame and finds its pixels in this one.

    Args:
        cell: side of a cell, working px.

    Attributes:
        flow: what the last vote found, or None.
    """

    def __init__(self, cell: int) -> None:
        self._config, self._cell = FlowConfig(), cell
        line = np.linspace(-0.5, 0.5, self._config.grid) * self._config.core
        self._grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
        self._before: _Seen | None = None
        self.flow: Flow | None = None

    def vote(self, look: Look) -> Plane | None:
        """0..1 for each place: near 1 where most points went, if most could be followed."""
        config, self.flow = self._config, None
        if self._before is None:
            return None
        window, gray = self._in_px(look)
        self.flow = self._trace(self._before, window, gray, look.expected)
        if self.flow is None or self.flow.share < config.least_share:
            return None
        column, row = look.corner_of(self.flow.centre).tolist()
        sigma = config.sigma * math.sqrt(look.cells[0] * look.cells[1])
        down = np.exp(-0.5 * ((np.arange(look.places[0]) - row) / sigma) ** 2)
        across = np.exp(-0.5 * ((np.arange(look.places[1]) - column) / sigma) ** 2)
        certain = self.flow.share * min(1.0, look.confidence / config.trusted)
        return np.asarray(certain * np.outer(down, across), np.float32)

    def learn(self, look: Look, box: Box, weight: float) -> None:
        """Remember where the target is, whether or not its look is learnt."""
        self._before = _Seen(*self._in_px(look), box)

    def forget(self) -> None:
        """The target was not seen: the next frame knows nothing of its pixels."""
        self._before = None
        self.flow = None

    def _in_px(self, look: Look) -> tuple[Window, Pixels]:
        window = look.frame.window.in_cells(1 / self._cell)
        return window, gray_of(window.pixels)

    def _trace(self, before: _Seen, window: Window, gray: Pixels, expected: Floats) -> Flow | None:
        """Follow the points of the last frame's box, which lead to about ``expected``."""
        config, centre = self._config, np.array(before.box.centre)
        if gray.shape != before.gray.shape:
            return None
        side = math.sqrt(before.box.area)
        start = centre + self._grid * (before.box.w, before.box.h)
        first = before.window.to_window(start)
        inside = ((first >= 0) & (first < before.gray.shape[::-1])).all(axis=1)
        points = np.asarray(first - 0.5, np.float32)
        moved = window.to_window(start + expected - centre)
        guess = np.asarray(moved - 0.5, np.float32)
        there, found = self._follow(before.gray, gray, points, guess)
        back, returned = self._follow(gray, before.gray, there, points)
        error = np.hypot(*(back - points).T)
        good = inside & found & returned & (error < config.there_and_back)
        if good.sum() < config.fewest:
            return None
        end = window.to_image(there.astype(np.float64) + 0.5)
        way = end - start
        good &= np.hypot(*(way - _median(way[good])).T) < config.together * side
        if good.sum() < config.fewest:
            return None
        shift = _median(way[good])
        growth, deviation = _growth(start[good] - centre, end[good], side)
        return Flow(shift, centre + shift, float(good.mean()), growth, deviation)

    def _follow(
        self, one: Pixels, other: Pixels, points: _Points, guess: _Points
    ) -> tuple[_Points, NDArray[np.bool_]]:
        """Places (P, 2) of ``points`` in another image, and (P,) whether they were found."""
        config = self._config
        kinds = cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS
        moved, status, _ = cv2.calcOpticalFlowPyrLK(
            one,
            other,
            points[:, None],
            guess[:, None].copy(),
            winSize=(config.patch, config.patch),
            maxLevel=config.levels,
            criteria=(kinds, config.iterations, config.settled),
            flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
            minEigThreshold=config.least_contrast,
        )
        return np.asarray(moved, np.float32)[:, 0], np.asarray(status)[:, 0] > 0


def _median(values: Floats) -> Floats:
    """Upper median of (P,) or (P, 2) over P; a fifth of the time of NumPy's for so few."""
    return np.asarray(np.sort(values, axis=0)[len(values) // 2])


def _growth(start: Floats, end: Floats, side: float) -> tuple[float, float]:
    """Logarithm of the slope of end on start (P, 2), and one point's deviation of it.

    Three rounds of reweighted least squares with Cauchy's weights 1 / (1 + (r / c)^2), c being
    1.5 medians of the residuals r.
    """
    weight = np.ones((len(start), 1))
    slope, spread, left = 1.0, 1.0, 0.0
    for _ in range(3):
        total = weight.sum()
        u = start - (weight * start).sum(axis=0) / total
        v = end - (weight * end).sum(axis=0) / total
        spread = max(float((weight * u * u).sum() / total), 1e-9)
        slope = float((weight * u * v).sum() / total) / spread
        residual = v - slope * u
        left = float((weight * residual**2).sum() / total)
        distance = np.hypot(*residual.T)
        scale = 1.5 * float(_median(distance)) + 1e-3 * side
        weight = (1 / (1 + (distance / scale) ** 2))[:, None]
    return math.log(min(max(slope, 0.5), 2.0)), math.sqrt(left / spread)
