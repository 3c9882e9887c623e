# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where in what is followed the target's centre is, by its colours.

A start box lies beside the target, or takes in background on one side, and the sub-patches keep to
what they were given. The colours tell one from the other after some frames: the mean likelihood
of many frames, laid over one another by where the target was found, shows its outline. The target
is where a box of its size holds most more of it than the ring around.
"""

from __future__ import annotations

import cv2
import numpy as np

from het_ros.tracking.colour import box_means
from het_ros.tracking.frame import Floats
from het_ros.tracking.gray import Plane
from het_ros.tracking.layers import Cells, whole

_KEPT = 0.93  # a frame, of the map: 14 frames or so
_FRAMES_FIRST = 5  # before the map says anything
_RING = 0.15  # width of the ring over the box's side
_SOFTNESS = 0.15  # places count by exp(contrast / this of the best)
_LEAST_SOFTNESS = 0.01
# Share of the way to where the colours say: beside a target is background, but above and below are
# collars, shadows and who else wears its colours. The slopes of the true centre over what is found
# on disturbed starts are about 0.9 and 0.5.
_BELIEVED = np.array([0.9, 0.4])
# Frame n goes 1 / (n + _SLOW) of the way, at least _SLOWEST: what covers half moves it late.
_SLOW = 20
_SLOWEST = 0.005
_FARTHEST = 0.25  # target's width and height


class Centring:
    """Follows how far the target's centre is from that of the sub-patches' layout.

    Args:
        cells: (w, h) of the target in cells.

    Attributes:
        offset: (x, y) float64, cells.
    """

    def __init__(self, cells: Cells) -> None:
        self._size = whole(cells)
        self.offset: Floats = np.zeros(2)
        self._sum = np.zeros((2 * self._size[1], 2 * self._size[0]), np.float32)
        self._weight = 0.0
        self._frames = 0

    def observe(self, likelihood: Plane, centre: Floats) -> None:
        """Take in a frame in which the target was found.

        Args:
            likelihood: (H, W) float32 of the colours, in cells.
            centre: (x, y) of the target, ``offset`` in it, cells.
        """
        # A px's place is its centre here, its corner elsewhere.
        middle = float(centre[0]) - 0.5, float(centre[1]) - 0.5
        width, height = self._size
        self._sum *= _KEPT
        self._sum += cv2.getRectSubPix(likelihood, (2 * width, 2 * height), middle)
        self._weight = _KEPT * self._weight + 1
        self._frames += 1
        if self._frames < _FRAMES_FIRST:
            return
        found = best_place(contrast(self._sum / self._weight, self._size))
        farthest = _FARTHEST * np.array(self._size)
        wanted = np.clip(_BELIEVED * (self.offset + found), -farthest, farthest)
        rate = max(1 / (self._frames + _SLOW), _SLOWEST)
        self.offset = self.offset + rate * (wanted - self.offset)


def contrast(likelihood: Plane, size: tuple[int, int]) -> Plane:
    """(h + 1, w + 1): mean in a box less that in the ring around it, by the box's corner.

    Args:
        likelihood: (2 h, 2 w) float32; beyond its border its last values are repeated.
        size: (w, h) of the box, which begins at columns 0..w and rows 0..h.
    """
    (width, height), places = size, (size[1] + 1, size[0] + 1)
    ring_x, ring_y = (max(1, round(_RING * side)) for side in size)
    wide = width + 2 * ring_x, height + 2 * ring_y
    padded = cv2.copyMakeBorder(likelihood, ring_y, ring_y, ring_x, ring_x, cv2.BORDER_REPLICATE)
    inner = box_means(likelihood, size, places)
    outer = box_means(np.asarray(padded, np.float32), wide, places)
    area, larger = width * height, wide[0] * wide[1]
    # The ring's mean follows from those of the two boxes.
    return np.asarray((inner - outer) * (larger / (larger - area)), np.float32)


def best_place(contrasts: Plane) -> Floats:
    """(x, y): centre of the places that are about as good as the best, from the middle place."""
    best = float(contrasts.max())
    weights = np.exp((contrasts - best) / max(_SOFTNESS * best, _LEAST_SOFTNESS))
    found = []
    for along in (weights.sum(axis=0), weights.sum(axis=1)):
        from_middle = np.arange(len(along)) - (len(along) - 1) / 2
        found.append(float(along @ from_middle / along.sum()))
    return np.array(found)
