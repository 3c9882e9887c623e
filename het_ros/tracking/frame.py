# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is made of one frame on its way through the layers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.compressive import Features
from het_ros.tracking.evidence import Evidence
from het_ros.tracking.gray import Plane
from het_ros.tracking.window import Window

Image = NDArray[np.uint8]
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """One frame's search window and what all layers read of it.

    Attributes:
        window: the pixels, with its places counted in cells.
        planes: C channels, (H, W) uint8.
        features: (m, rows, columns), maps of the compressive features.
        growth: size at which the target is looked for, over that of its first box.
    """

    window: Window
    planes: tuple[Image, ...]
    features: Features
    growth: float


@dataclass(frozen=True)
class Measurement:
    """What bottom and middle layer make of a frame.

    Attributes:
        corner: y_COM, the corner of the sub-patches' layout, cells of the window.
        patch_corners: p (Q, 2), where the sub-patches were found, cells.
        omega: (Q,) weights of the sub-patches.
        evidence: raw evidence for the place, or None where nothing judges it.
        scores: (Q, rows, columns) of the base ensembles.
        likelihood: (H, W) of the colours in the window, in cells, or None without them.
        ratio: by which the target's size is drawn to what it was in the first frame.
    """

    corner: Floats
    patch_corners: Floats
    omega: Floats
    evidence: Evidence | None
    scores: Features
    likelihood: Plane | None = None
    ratio: float = 1.0
