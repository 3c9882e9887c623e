# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much memory a frame asks for anew."""

from __future__ import annotations

import tracemalloc

from het_ros.bench.footage import Footage
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.tracker import HierarchicalEnsembleTracker


def peak_of_a_frame(
    config: TrackerConfig, footage: Footage, box: Box, frames: int = 5, warm_up: int = 3
) -> float:
    """The most memory that one ``update`` holds beyond what was there before it, MB.

    Counts what Python and NumPy ask for, not what OpenCV does inside one call.
    """
    tracker = HierarchicalEnsembleTracker(config)
    tracker.init(footage[0], box)
    most = 0
    for i in range(1, 1 + warm_up + frames):
        tracemalloc.start()
        try:
            tracker.update(footage[i], 1 / 30)
            if i > warm_up:
                most = max(most, tracemalloc.get_traced_memory()[1])
        finally:
            tracemalloc.stop()
    return most / 1e6
