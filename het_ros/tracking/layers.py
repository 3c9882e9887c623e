# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The layers of a target's model as its configuration and its first box make them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.base_ensembles import BaseEnsembles, NaiveBayes
from het_ros.tracking.box import Box
from het_ros.tracking.colour import ColourModel
from het_ros.tracking.compressive import CompressiveFeatures, draw_measurement_matrix
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.motion import AdaptiveKalman
from het_ros.tracking.ridge import RidgeEnsembles
from het_ros.tracking.scale import ScaleFilter
from het_ros.tracking.size_regression import SizeRegression

Cells = tuple[float, float]


def grid(config: TrackerConfig, box: Box) -> tuple[Cells, NDArray[np.float64]]:
    """Size (w, h) of the target in cells, and the image px (x, y) that a cell covers at first.

    At a working resolution the target is a whole number of cells.
    """
    if not config.working_side:
        return (box.w / config.cell, box.h / config.cell), np.full(2, float(config.cell))
    side = config.working_side / config.cell / math.sqrt(box.area)
    width, height = (max(4, round(length * side)) for length in (box.w, box.h))
    return (width, height), np.array([box.w / width, box.h / height])


def whole(cells: Cells, unit: int = 1) -> tuple[int, int]:
    """A size (w, h) in cells of ``unit`` px in whole px; of the smallest target at least 1."""
    return max(1, round(cells[0] * unit)), max(1, round(cells[1] * unit))


def compressive_features(
    config: TrackerConfig, size: tuple[int, int], channels: int, rng: np.random.Generator
) -> CompressiveFeatures:
    """Features of sub-patches of ``size`` (w, h), cells, over that many channels."""
    matrix = draw_measurement_matrix(
        size, channels, config.features, config.rectangles, rng, config.largest_rectangle
    )
    ridge = config.base_ensemble == "ridge"
    return CompressiveFeatures(matrix, np.float32 if ridge else np.float64)


def base_ensembles(config: TrackerConfig, cells: Cells) -> BaseEnsembles:
    """The bottom layer for a target of ``cells`` (w, h)."""
    if config.base_ensemble == "ridge":
        sigma = config.label_sigma * math.sqrt(cells[0] * cells[1])
        return RidgeEnsembles(
            1 - config.learning_rate,
            config.ridge,
            (sigma, sigma),
            config.target_emphasis,
            config.first_frame,
        )
    return NaiveBayes(
        config.learning_rate,
        config.positive_radius / config.cell,
        config.negative_radius / config.cell,
        config.sigma_floor,
    )


def colour_model(config: TrackerConfig, cells: Cells) -> ColourModel:
    """Colour histograms for a target of ``cells`` (w, h)."""
    return ColourModel(whole(cells, config.cell), config.colour_rate)


def scale_filter(config: TrackerConfig, cells: Cells) -> ScaleFilter:
    """The filter over sizes for a target of ``cells`` (w, h)."""
    return ScaleFilter(
        whole(cells),
        config.scales,
        config.scale_step,
        config.scale_context,
        config.scale_rate,
        config.first_frame,
    )


def size_regression(config: TrackerConfig, cells: Cells) -> SizeRegression:
    """The regression of the size of a target of ``cells`` (w, h)."""
    return SizeRegression(
        whole(cells), config.scale_context, config.scale_rate, config.first_frame
    )


def motion_model(config: TrackerConfig, box: Box) -> AdaptiveKalman:
    """The top layer for a target that starts in ``box``; its noises are in target sides."""
    side = math.sqrt(box.area)
    return AdaptiveKalman(
        np.array(box.centre),
        config.acceleration * side,
        config.measurement_noise * side,
        config.nominal_dt,
        config.longest_dt,
    )
