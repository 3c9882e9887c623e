# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where in the whole image the colours would look for a hidden target."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.colour import ColourModel
from het_ros.tracking.window import cut_window

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]

_TARGET_SIDE = 12.0  # px of the miniature
_LONGEST_SIDE, _SHORTEST_SIDE = 240.0, 48.0  # px of the miniature's longer side
_BY_DISTANCE = 0.02  # of likelihood lost for each target size from where it was last seen
_LOOKED_AT = 0.3  # of likelihood lost by a place that was just looked at, ...
_FORGIVEN = 0.85  # ... and what is left of that after one more look
_COVERED = 0.7  # of a search window's reach: nearer places were looked at with it
_REMEMBERED = 12  # looks


class ColourSearch:
    """Names one place after the other, the likeliest first, those looked at lately last."""

    def __init__(self) -> None:
        self._looked_at: deque[Floats] = deque(maxlen=_REMEMBERED)

    def forget(self) -> None:
        """The target is in sight: where it was not is of no more interest."""
        self._looked_at.clear()

    def next_place(
        self,
        image: Image,
        colours: Callable[[Image], Image],
        model: ColourModel,
        box: Box,
        reach: Floats,
    ) -> Floats:
        """(x, y), image px, of the centre of the next place to look at.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            colours: makes of its pixels what the colour model knows.
            model: of the target.
            box: the target where it was last seen.
            reach: (x, y), image px, how far a search window reaches from its centre.
        """
        small, scale = miniature(image, math.sqrt(box.area))
        likelihood = model.likelihood(colours(small))
        size = tuple(max(1, round(side * scale)) for side in (box.w, box.h))
        blurred = cv2.boxFilter(likelihood, cv2.CV_32F, size, borderType=cv2.BORDER_CONSTANT)
        score = np.asarray(blurred, np.float64)
        x, y = ((np.arange(length) + 0.5) / scale for length in score.shape[::-1])
        away_x, away_y = (x - box.centre[0]) / box.w, (y - box.centre[1]) / box.h
        score -= _BY_DISTANCE * np.hypot(away_x[None, :], away_y[:, None])
        lost = _LOOKED_AT
        for place in reversed(self._looked_at):
            columns = np.flatnonzero(np.abs(x - place[0]) < _COVERED * reach[0])
            rows = np.flatnonzero(np.abs(y - place[1]) < _COVERED * reach[1])
            score[np.ix_(rows, columns)] -= lost
            lost *= _FORGIVEN
        row, column = divmod(int(score.argmax()), score.shape[1])
        place = np.array([x[column], y[row]])
        self._looked_at.append(place)
        return place


def miniature(image: Image, side: float) -> tuple[Image, float]:
    """The whole image, (h, w, ...) uint8, with a target of ``side`` px at 12 px, and its scale.

    Where the image would have more than 240 px in its longer side it is smaller, and larger where
    it would have less than 48.
    """
    longest = max(image.shape[:2])
    scale = min(1.0, _TARGET_SIDE / side, _LONGEST_SIDE / longest)
    scale = min(1.0, max(scale, _SHORTEST_SIDE / longest))
    height, width = (max(1, round(length * scale)) for length in image.shape[:2])
    return cut_window(image, 0.0, 0.0, width, height, (scale, scale)).pixels, scale
