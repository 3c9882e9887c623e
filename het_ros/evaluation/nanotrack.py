# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""NanoTrack over cv2.dnn: how it moves by its network's maps.

``cv2.TrackerNano`` takes version 2 only; this one takes both.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.answers import Answer
from het_ros.tracking.bottom.siamese import CONTEXT, Siamese
from het_ros.tracking.box import Box

LEAST = 10.0  # px, smallest side that it gives


@dataclass(frozen=True)
class Habits:
    """How a tracker weighs its network's maps.

    Attributes:
        window: share of a Hann window in the choice of the place, 0..1.
        penalty: how much a change of size or aspect counts against a box.
        rate: learning rate of the size.
    """

    window: float
    penalty: float
    rate: float


HABITS = {"v2": Habits(0.490, 0.150, 0.385), "v3": Habits(0.455, 0.138, 0.348)}


class NanoTrack:
    """NanoTrack; its score is the best place's probability."""

    def __init__(self, folder: Path, seed: int = 0) -> None:
        self._network = Siamese.read(folder)
        self._habits = HABITS[self._network.version]
        hann = np.hanning(self._network.places)
        self._window = np.outer(hann, hann)

    def init(self, image: NDArray[np.uint8], box: Box) -> None:
        """Start on a box."""
        x, y, w, h = box.as_tuple()
        self._centre, self._size = (x + w / 2, y + h / 2), (w, h)
        self._network.template(image, box)

    def update(self, image: NDArray[np.uint8], dt: float) -> Answer:
        """Follow into the next image; ``dt`` is of no use to it."""
        score, boxes = self._network.look(image, self._centre, self._size)
        kept = likeness(boxes[2:], self._size, self._habits.penalty)
        window = self._habits.window
        votes = (1 - window) * kept * score + window * self._window
        best = np.unravel_index(int(votes.argmax()), votes.shape)
        x, y, w, h = (float(value) for value in boxes[:, best[0], best[1]])
        rate = float(kept[best] * score[best]) * self._habits.rate
        height, width = image.shape[:2]
        self._centre = (
            float(np.clip(x + w / 2, 0, width)),
            float(np.clip(y + h / 2, 0, height)),
        )
        self._size = (
            float(np.clip(self._size[0] + rate * (w - self._size[0]), LEAST, width)),
            float(np.clip(self._size[1] + rate * (h - self._size[1]), LEAST, height)),
        )
        (cx, cy), (w, h) = self._centre, self._size
        return Answer((cx - w / 2, cy - h / 2, w, h), score=float(score[best]))


def likeness(
    sizes: NDArray[np.float32], size: tuple[float, float], penalty: float
) -> NDArray[np.float64]:
    """How little sizes differ from the known one, 0..1: exp(-penalty (s a - 1)).

    s and a are the factors, over 1, by which the extent and the aspect change (Li et al.,
    "High Performance Visual Tracking with Siamese Region Proposal Network", CVPR 2018).

    Args:
        sizes: (2, n, n) widths and heights, px.
        size: the known width and height, px.
        penalty: how much a change counts.
    """
    w, h = np.maximum(sizes.astype(np.float64), 1e-3)
    extent = _factor(_extent(w, h) / _extent(*size))
    aspect = _factor((w / h) / (size[0] / size[1]))
    return np.asarray(np.exp(-penalty * (extent * aspect - 1)))


def _extent(w: NDArray[np.float64] | float, h: NDArray[np.float64] | float) -> NDArray[np.float64]:
    context = CONTEXT * (w + h)
    return np.asarray(np.sqrt((w + context) * (h + context)))


def _factor(ratio: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.maximum(ratio, 1 / ratio))
