# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a hidden target is looked for: in turns at its prediction and wherever it may be.

Every second frame looks at the prediction. In between the search goes to places that another
detector names, to where the target's colours are, and around the place where it was last seen,
farther and farther out. What is found there is accepted by its confidence alone.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.features.channels import Pixels, Plane
from het_ros.tracking.features.window import cut_window

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SearchConfig:
    """Constants of the search; all chosen.

    Attributes:
        by_colour: of so many frames away from the prediction, all but one go by colour.
        target_side: side of the target in the reduced image that is searched by colour, px.
        longest, shortest: longer side of that image at most and at least, px.
        by_distance: likelihood lost for each target side from where it was last seen.
        looked_at: likelihood lost by a place that was just looked at ...
        forgiven: ... and what is left of that loss after one more look.
        covered: part of a search window's reach that a look has covered.
        remembered: looks.
    """

    by_colour: int = 3
    target_side: float = 12.0
    longest: float = 240.0
    shortest: float = 48.0
    by_distance: float = 0.02
    looked_at: float = 0.3
    forgiven: float = 0.85
    covered: float = 0.7
    remembered: int = 12


class Redetection:
    """Names the place to look at, frame by frame, while a target is hidden."""

    def __init__(self) -> None:
        self._config = SearchConfig()
        self._looked_at: deque[Floats] = deque(maxlen=self._config.remembered)

    def forget(self) -> None:
        """The target is there: where it was not is of no more interest."""
        self._looked_at.clear()

    def next_place(
        self,
        hidden: int,
        predicted: Floats,
        last: Box,
        reach: Floats,
        image: Pixels,
        likelihood: Callable[[Pixels], Plane] | None,
        candidates: Sequence[Box] = (),
    ) -> Floats:
        """(x, y), image px: where the search window goes in this frame.

        Args:
            hidden: frames since the target was last seen; 0 for one that is there.
            predicted: (x, y) by the motion model, px.
            last: the target where it was last seen, px.
            reach: (x, y), how far one search window reaches, px.
            image: (H, W, 3) or (H, W) uint8, the whole one.
            likelihood: (h, w) float32 that pixels (h, w, ...) are the target's, where colours say.
            candidates: boxes that another detector suggests.
        """
        if hidden % 2 == 0:
            return predicted
        turn = hidden // 2
        if candidates:
            by_distance = sorted(candidates, key=lambda box: _distance(box.centre, predicted))
            return np.array(by_distance[turn % len(by_distance)].centre)
        if likelihood is not None and turn % self._config.by_colour:
            return self._by_colour(image, likelihood, last, reach)
        return np.array(last.centre) + _spiral(turn // self._config.by_colour) * reach

    def _by_colour(
        self, image: Pixels, likelihood: Callable[[Pixels], Plane], last: Box, reach: Floats
    ) -> Floats:
        """The place whose colours are most like the target's, those looked at lately last."""
        config = self._config
        small, scale = _reduced(image, math.sqrt(last.area), config)
        size = tuple(max(1, round(side * scale)) for side in (last.w, last.h))
        means = cv2.boxFilter(likelihood(small), cv2.CV_32F, size, borderType=cv2.BORDER_CONSTANT)
        score = np.asarray(means, np.float64)
        x, y = ((np.arange(length) + 0.5) / scale for length in score.shape[::-1])
        away_x, away_y = (x - last.centre[0]) / last.w, (y - last.centre[1]) / last.h
        score -= config.by_distance * np.hypot(away_x[None, :], away_y[:, None])
        lost = config.looked_at
        for place in reversed(self._looked_at):
            columns = np.flatnonzero(np.abs(x - place[0]) < config.covered * reach[0])
            rows = np.flatnonzero(np.abs(y - place[1]) < config.covered * reach[1])
            score[np.ix_(rows, columns)] -= lost
            lost *= config.forgiven
        row, column = divmod(int(score.argmax()), score.shape[1])
        place = np.array([x[column], y[row]])
        self._looked_at.append(place)
        return place


def _spiral(turn: int) -> Floats:
    """(x, y) of the ``turn``-th place on square rings around (0, 0), the nearest ring first.

    After the third ring the search begins again.
    """
    places = [(0, 0)]
    for ring in (1, 2, 3):
        steps = range(-ring, ring + 1)
        around = [(x, y) for x in steps for y in steps if max(abs(x), abs(y)) == ring]
        places += sorted(around, key=lambda place: (math.hypot(*place), place))
    return np.array(places[turn % len(places)], np.float64)


def _distance(place: tuple[float, float], other: Floats) -> float:
    return math.hypot(place[0] - other[0], place[1] - other[1])


def _reduced(image: Pixels, side: float, config: SearchConfig) -> tuple[Pixels, float]:
    """The whole image at the scale at which a target of ``side`` px is small, and that scale."""
    longest = max(image.shape[:2])
    scale = min(1.0, config.target_side / side, config.longest / longest)
    scale = min(1.0, max(scale, config.shortest / longest))
    height, width = (max(1, round(length * scale)) for length in image.shape[:2])
    return cut_window(image, 0.0, 0.0, width, height, (scale, scale)).pixels, scale
