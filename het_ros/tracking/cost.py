# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a target costs before it is started: a box or a parameter must not take all memory."""

from __future__ import annotations

import math

from het_ros.tracking.config import TrackerConfig


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
    """About what window, maps and template take, MB; rather too much than too little.

    Args:
        config: parameters.
        cells: (w, h) of the target in cells of the search window.
    """
    margin = 2 * (math.ceil(config.search_radius / config.cell) + 1)
    places = (cells[0] + margin) * (cells[1] + margin)
    feature = 8 if config.base_ensemble == "ridge" else 12
    place = (
        feature * config.features
        + 16 * config.sub_patches
        + 16 * len(config.channels)
        + 16 * config.cell**2
    )
    template = 4 * config.features * cells[0] * cells[1] if config.size_template else 0
    return (places * place + 16 * config.features**2 + template) / 1e6
