# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a target costs before it is started: a box or a parameter must not take all memory."""

from __future__ import annotations

from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.features.extractor import WindowConfig


def check_cost(config: TrackerConfig, cells: tuple[float, float]) -> None:
    """Raise ValueError where a target would take more than ``config.most_memory``.

    Args:
        config: parameters.
        cells: (w, h) of the target in cells of the search window.
    """
    needed = megabytes(config, cells)
    if needed > config.most_memory:
        raise ValueError(
            f"the target takes {needed:.0f} MB with these parameters, most_memory is "
            f"{config.most_memory:g}: send a smaller or less narrow box, or lower working_side, "
            "search_radius or features"
        )


def megabytes(config: TrackerConfig, cells: tuple[float, float]) -> float:
    """About what window, maps and statistics take, MB; rather too much than too little.

    Args:
        config: parameters.
        cells: (w, h) of the target in cells of the search window.
    """
    window = WindowConfig()
    cell, channels = window.cell, len(window.channels)
    margin = 2 * window.margin_of(config.search_radius)
    places = (cells[0] + margin) * (cells[1] + margin)
    place = 12 * config.features + 16 * config.sub_patches + 16 * channels + 16 * cell**2
    return (places * place + 32 * config.features**2) / 1e6
