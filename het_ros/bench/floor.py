# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The floor: what no tracker of this kind can leave out, timed alone at the same sizes.

It reads the search window once, makes the integral images of its channels, and does one matrix
product, of the ensembles' votes with the feature maps.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from het_ros.tracking.bottom.sub_patches import draw_layout
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.features.extractor import WindowConfig, target_cells


@dataclass(frozen=True)
class Sizes:
    """How much a frame's work is.

    Attributes:
        window: (H, W) of the search window, px.
        cells: (rows, columns) of its channels.
        places: number of places at which the features are taken.
        channels: C.
        features: m.
        sub_patches: Q.
    """

    window: tuple[int, int]
    cells: tuple[int, int]
    places: int
    channels: int
    features: int
    sub_patches: int


def sizes_of(config: TrackerConfig) -> Sizes:
    """The sizes for a square target."""
    window = WindowConfig()
    target = target_cells((1.0, 1.0), config.working_side)
    rng = np.random.default_rng(config.seed)
    patch = draw_layout(target, config.sub_patches, config.sub_patch_fraction, rng).size
    side = target[0] + 2 * window.margin_of(config.search_radius)
    places = side - patch[0] + 1
    return Sizes(
        window=(side * window.cell, side * window.cell),
        cells=(side, side),
        places=places**2,
        channels=len(window.channels),
        features=config.features,
        sub_patches=config.sub_patches,
    )


def floor(sizes: Sizes, frame: Callable[[], object], repetitions: int = 150) -> dict[str, float]:
    """Median time of each unavoidable pass and of a whole frame, ms, all in turns.

    Args:
        sizes: of the passes.
        frame: does one frame of a tracker with these sizes. Timed in turns with the passes, it
            meets the same machine and leaves them as cold a cache as they have in a frame.
        repetitions: of each.

    Returns:
        ``frame_ms``;
        ``window_ms``, ``integrals_ms``, ``product_ms`` and their sum ``total_ms``; beside it
        ``learning_product_ms``, the product (m, places) (places, m) of learning by ridge
        regression, which is not part of the sum.
    """
    rng = np.random.default_rng(0)
    window = rng.integers(0, 255, (*sizes.window, 3), np.uint8)
    planes = [rng.integers(0, 255, sizes.cells, np.uint8) for _ in range(sizes.channels)]
    votes = rng.standard_normal((sizes.sub_patches, sizes.features)).astype(np.float32)
    maps = rng.standard_normal((sizes.features, sizes.places)).astype(np.float32)
    scores = np.empty((sizes.sub_patches, sizes.places), np.float32)
    gram = np.empty((sizes.features, sizes.features), np.float32)
    target = np.empty_like(window)
    passes: dict[str, Callable[[], object]] = {
        "window": lambda: np.copyto(target, window),
        "integrals": lambda: [cv2.integral(plane) for plane in planes],
        "product": lambda: np.matmul(votes, maps, out=scores),
        "learning_product": lambda: np.matmul(maps, maps.T, out=gram),
        "frame": frame,
    }
    times = {name: np.empty(repetitions) for name in passes}
    for i in range(repetitions):
        for name, work in passes.items():
            begun = time.perf_counter()
            work()
            times[name][i] = time.perf_counter() - begun
    found = {f"{name}_ms": float(1e3 * np.median(t)) for name, t in times.items()}
    found["total_ms"] = sum(found[f"{name}_ms"] for name in ("window", "integrals", "product"))
    return found
