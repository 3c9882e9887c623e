# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A siamese network as one more base ensemble: it knows shapes, sizes and how they change.

It is given the first box and never learns again. What it proposes is one of its own boxes, chosen
as its authors do: boxes of another size or aspect than the last count less, and so do places far
from the prediction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.resemblance import Resemblance
from het_ros.tracking.bottom.second_thread import SecondThread
from het_ros.tracking.bottom.siamese import Siamese
from het_ros.tracking.box import Box
from het_ros.tracking.features.channels import Pixels, bgr_of

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NetworkConfig:
    """Constants of the proposal, of NanoTrack v3 (github.com/HonglinChu/SiamTrackers).

    Attributes:
        window: share of the Hann window around the prediction.
        penalty: for a change of size and aspect.
        smallest: side of a box, px (geometry).
        bias: part of the difference of the first box from the network's own there that is kept
            (chosen: half, what is given is drawn by other rules than the network's boxes).
        most_bias: most of that difference, in logarithms of the size and in sides (chosen).
    """

    window: float = 0.455
    penalty: float = 0.138
    smallest: float = 2.0
    bias: float = 0.5
    most_bias: float = 0.4


@dataclass(frozen=True)
class Proposal:
    """What the network says of a frame.

    Attributes:
        box: its best box, image px.
        score: that box's own probability, 0..1; it is high on anything like a thing.
        steady: 0..1, near 1 for a box of about the size and aspect of the last.
        resemblance: of the places in its crop to the first box.
    """

    box: Box
    score: float
    steady: float
    resemblance: Resemblance


class NetworkEnsemble:
    """Looks for the target of its first box.

    Args:
        folder: of the network's files; see :meth:`Siamese.read`.
        beside: whether it may look in a thread of its own.

    Raises:
        ValueError: the files are missing or no such network.
    """

    def __init__(self, folder: Path, beside: bool = False) -> None:
        self._config = NetworkConfig()
        self._network = Siamese.read(folder)
        hann = np.hanning(self._network.places)
        self._window = np.outer(hann, hann)
        self._stretch, self._offset = np.ones(2), np.zeros(2)
        self._thread = SecondThread(beside)

    def start(self, image: Pixels, box: Box) -> None:
        """Take the target in ``box`` of the image, (H, W, 3) or (H, W) uint8."""
        pixels = bgr_of(image)
        self._network.template(pixels, box)
        scores, boxes = self._network.look(pixels, box.centre, (box.w, box.h))
        best = np.unravel_index(int((scores * self._window).argmax()), scores.shape)
        x, y, width, height = boxes[:, best[0], best[1]].tolist()
        wanted = np.array([box.w, box.h])
        seen = np.maximum(np.array([width, height]), self._config.smallest)
        most, belief = self._config.most_bias, self._config.bias
        self._stretch = np.exp(belief * np.clip(np.log(wanted / seen), -most, most))
        middle = np.array([x + width / 2, y + height / 2])
        self._offset = belief * np.clip((np.array(box.centre) - middle) / seen, -most, most)

    def begin(self, image: Pixels, at: Floats, size: Floats) -> Callable[[], Proposal]:
        """Begin :meth:`propose`; what is handed back waits for the proposal.

        The image must not be written until then.
        """
        return self._thread.begin(self.propose, image, at, size)

    def propose(self, image: Pixels, at: Floats, size: Floats) -> Proposal:
        """Look around a place.

        Args:
            image: (H, W, 3) or (H, W) uint8, the whole one.
            at: (x, y), image px: middle of the search crop.
            size: (w, h) of the target as it is known, image px.
        """
        config = self._config
        width, height = size.tolist()
        scores, boxes = self._network.look(bgr_of(image), (at[0], at[1]), (width, height))
        sides = np.maximum(boxes[2:].astype(np.float64), config.smallest)
        offsets = self._offset[:, None, None] * sides
        centres = np.moveaxis(boxes[:2] + boxes[2:] / 2 + offsets, 0, -1)
        w, h = self._stretch[:, None, None] * sides
        larger = _context(w, h) / _context(width, height)
        aspect = (w / h) / (width / height)
        change = np.maximum(larger, 1 / larger) * np.maximum(aspect, 1 / aspect)
        steady = np.exp(-config.penalty * (change - 1))
        ranked = steady * scores * (1 - config.window) + config.window * self._window
        best = np.unravel_index(int(ranked.argmax()), ranked.shape)
        x, y = centres[best].tolist()
        box = Box.from_centre(x, y, float(w[best]), float(h[best]))
        score, alike = float(scores[best]), self._network.resemblance()
        return Proposal(box, score, float(steady[best]), alike)


def _context(width: NDArray[np.float64] | float, height: NDArray[np.float64] | float) -> Floats:
    """Side of a square with the area of a box and its surroundings."""
    around = (width + height) / 2
    return np.sqrt((width + around) * (height + around))
