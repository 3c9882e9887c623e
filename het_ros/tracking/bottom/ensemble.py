# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the tracker asks of every base ensemble."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.features.channels import Pixels
from het_ros.tracking.features.frame import Frame

Floats = NDArray[np.float64]
Plane = NDArray[np.float32]


@dataclass(frozen=True)
class Look:
    """One look at an image, as base ensembles get it.

    Attributes:
        frame: search window, channels and features.
        image: (H, W, 3) or (H, W) uint8, the whole one.
        expected: (x, y) of the target by the motion model, image px.
        size: (w, h) of the target, image px.
        cells: (w, h) of the target in cells of the window.
        places: (rows, columns) of the target's corner that are voted for.
        confidence: score of the last frame, 0..1.
    """

    frame: Frame
    image: Pixels
    expected: Floats
    size: Floats
    cells: tuple[int, int]
    places: tuple[int, int]
    confidence: float

    def middle_of(self, corner: Floats) -> Floats:
        """(x, y), cells: the middle of a target with its ``corner`` (..., 2) there, cells."""
        return np.asarray(corner + np.array(self.cells) / 2)

    def corner_of(self, centre: Floats) -> Floats:
        """(x, y), cells: the corner of a target with its ``centre`` (..., 2) there, image px."""
        return self.frame.window.to_window(centre) - np.array(self.cells) / 2

    def centre_of(self, corner: Floats) -> Floats:
        """(x, y), image px: the centre of a target with its ``corner`` (..., 2) there, cells."""
        return self.frame.window.to_image(corner + np.array(self.cells) / 2)


class BaseEnsemble(Protocol):
    """One opinion on the target's place; the tracker asks all of them in a loop."""

    def vote(self, look: Look) -> Plane | None:
        """How likely each place of the target's corner is, ``look.places`` float32, or None.

        Additive opinions lie in 0..1 or so; None says that this ensemble knows nothing now.
        """

    def learn(self, look: Look, box: Box, weight: float) -> None:
        """The target is in ``box``, image px.

        Args:
            look: the look that it was found in.
            box: the target.
            weight: 0..1, how much of its rate it learns with; 0: it was followed, not learnt.
        """

    def forget(self) -> None:
        """The target was not seen in this frame."""


# Makes a base ensemble for a new target: (H, W, 3) or (H, W) uint8 and the box in it, image px.
EnsembleFactory = Callable[[Pixels, Box], BaseEnsemble]
