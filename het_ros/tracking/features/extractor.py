# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From an image to a frame: search window, channels, compressive features."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.channels import (
    ChannelConfig,
    Pixels,
    bgr_of,
    channel_stack,
    gray_of,
    is_colourless,
    names_for,
)
from het_ros.tracking.features.compressive import (
    CompressiveFeatures,
    draw_measurement_matrix,
    integral_images,
)
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.features.window import cut_window

Floats = NDArray[np.float64]
Cells = tuple[int, int]


@dataclass(frozen=True)
class WindowConfig:
    """How a target is looked at.

    Attributes:
        cell: side of a cell over which channels are averaged, working px (chosen: half the time
            of 1, no less exact).
        least_cells: a side of a target in cells, at least (geometry: a sub-patch needs room).
        rectangles: Z, most rectangles of a feature (paper).
        margin: cells around the search radius (geometry: sub-cell places reach one cell over).
        channels: by name, of colour images (chosen: colour, and edges by direction as
            histograms of gradients have them).
    """

    cell: int = 2
    least_cells: int = 4
    rectangles: int = 4
    margin: int = 1
    channels: tuple[str, ...] = (
        "lightness",
        "green_red",
        "blue_yellow",
        "gradient",
        *(f"orientation{k}" for k in range(ChannelConfig().orientations)),
    )

    def margin_of(self, search_radius: float) -> int:
        """Cells of a search window around the target, for a radius in working px."""
        return math.ceil(search_radius / self.cell) + self.margin


def target_cells(box_size: tuple[float, float], working_side: float) -> Cells:
    """(w, h) in cells of a target of (w, h) px."""
    window = WindowConfig()
    scale = working_side / window.cell / math.sqrt(box_size[0] * box_size[1])
    width, height = (max(window.least_cells, round(side * scale)) for side in box_size)
    return width, height


class FeatureExtractor:
    """Looks at one target, always with as many cells, whatever its size in the image.

    Args:
        image: the first one, (H, W, 3) or (H, W) uint8; it says whether colour counts.
        cells: (w, h) of the target in cells.
        sub_patch: (w, h) of a sub-patch in cells.
        features: m, number of compressive features.
        search_radius: how far a search window reaches, working px.
        gray_below: see :func:`is_colourless`.
        rng: draws the measurement matrix.

    Attributes:
        cells: as given.
        cell: side of a cell, working px.
        gray: whether the target is followed without colour.
    """

    def __init__(
        self,
        image: Pixels,
        cells: Cells,
        sub_patch: Cells,
        features: int,
        search_radius: float,
        gray_below: float,
        rng: np.random.Generator,
    ) -> None:
        config = WindowConfig()
        self.cells, self.cell = cells, config.cell
        self.gray = is_colourless(image, gray_below)
        self._radius = search_radius / config.cell
        self._margin = config.margin_of(search_radius)
        self._channels = names_for(config.channels, self.gray)
        matrix = draw_measurement_matrix(
            sub_patch, len(self._channels), features, config.rectangles, rng
        )
        self._features = CompressiveFeatures(matrix, np.float32)

    def reach(self, size: Floats) -> Floats:
        """(x, y), image px: how far from a window's centre a target of ``size`` is found."""
        return np.asarray(self._radius * size / np.array(self.cells))

    def look(self, image: Pixels, centre: Floats, size: Floats) -> Frame:
        """The search window around a place, and all that is read of it.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            centre: (x, y), image px.
            size: (w, h) of the target, image px.
        """
        unit = size / np.array(self.cells)
        corner = centre - size / 2 - self._margin * unit
        width, height = ((side + 2 * self._margin) * self.cell for side in self.cells)
        scale_x, scale_y = (self.cell / unit).tolist()
        x, y = corner.tolist()
        window = cut_window(image, x, y, width, height, (scale_x, scale_y))
        window = replace(window, pixels=self.in_kind(window.pixels))
        channels = channel_stack(window.pixels, self._channels, self.cell)
        maps = self._features.maps(integral_images(channels))
        return Frame.of(window.in_cells(self.cell), channels, maps)

    def in_kind(self, pixels: Pixels) -> Pixels:
        """Pixels gray (H, W) or in colour (H, W, 3), as the first image was."""
        return gray_of(pixels) if self.gray else bgr_of(pixels)
