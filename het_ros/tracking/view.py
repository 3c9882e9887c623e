# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From an image to a frame: the search window, its channels and its feature maps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from het_ros.tracking.box import Box
from het_ros.tracking.channels import channel_stack, names_for
from het_ros.tracking.compressive import integral_images
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.frame import Floats, Frame, Image
from het_ros.tracking.gray import bgr_of, gray_of, is_colourless
from het_ros.tracking.layers import Cells, compressive_features
from het_ros.tracking.light import Light
from het_ros.tracking.window import Window, cut_window, turned


class View:
    """How one target is looked at: at a resolution, in channels and features of its own.

    Args:
        config: parameters.
        image: the first one, (H, W, 3) or (H, W) uint8.
        box: the target in it.
        cells: (w, h) of the target in cells.
        unit: image px (x, y) that a cell covers at first.
        sub_patch: (w, h) of a sub-patch, cells.
        rng: draws the features.

    Attributes:
        gray: whether the target is followed without colour, as its first image has none.
        features: the compressive features it is looked at in.
    """

    def __init__(
        self,
        config: TrackerConfig,
        image: Image,
        box: Box,
        cells: Cells,
        unit: Floats,
        sub_patch: tuple[int, int],
        rng: np.random.Generator,
    ) -> None:
        self._cell = config.cell
        self._at_working_resolution = config.working_side > 0
        self._size = np.array([box.w, box.h])
        self._cells = cells
        self._unit = unit
        self._radius = config.search_radius / config.cell
        self.gray = is_colourless(image, config.gray_below)
        self._channels = names_for(config.channels, self.gray)
        self.features = compressive_features(config, sub_patch, len(self._channels), rng)
        self._light = Light() if config.light_jumps else None

    def reach(self, growth: float) -> Floats:
        """(x, y), image px: how far from a window's centre the target is found in it."""
        return np.asarray(self._radius * self._unit * growth)

    def look(
        self,
        image: Image,
        centre: Floats,
        growth: float,
        angle: float = 0.0,
        elsewhere: bool = False,
        again: bool = False,
    ) -> Frame:
        """The window with every place at which a sub-patch is looked for, and its maps.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            centre: (x, y) of the window, image px.
            growth: size at which the target is looked for, over that of its first box.
            angle: rad, clockwise, that the window is turned by.
            elsewhere: whether it shows another place than the last window did.
            again: whether the same place of the same image was just looked at, turned otherwise.
        """
        margin = math.ceil(self._radius) + (0 if self._at_working_resolution else 1)
        unit = self._unit * growth
        corner = centre - turned(self._size * growth / 2 + margin * unit, angle)
        width, height = (math.ceil(cells) + 2 * margin for cells in self._cells)
        scale = self._cell / unit
        window = cut_window(
            image,
            float(corner[0]),
            float(corner[1]),
            width * self._cell,
            height * self._cell,
            (float(scale[0]), float(scale[1])),
            angle,
        )
        window = self._as_at_first(window, elsewhere, again)
        planes = channel_stack(window.pixels, self._channels, self._cell)
        features = self.features.maps(integral_images(planes))
        return Frame(window.in_cells(self._cell), planes, features, growth)

    def colours(self, pixels: Image) -> Image:
        """Pixels (H, W, 3) or (H, W), gray or in colour and in the light of the first image."""
        pixels = self._in_kind(pixels)
        return self._light.undo(pixels) if self._light else pixels

    def _in_kind(self, pixels: Image) -> Image:
        return gray_of(pixels) if self.gray else bgr_of(pixels)

    def _as_at_first(self, window: Window, elsewhere: bool, again: bool) -> Window:
        """The window, gray or in colour as the first, without jumps of light since then."""
        pixels = self._in_kind(window.pixels)
        if self._light:
            if elsewhere:
                self._light.forget()
            elif not again:
                self._light.observe(pixels)
            pixels = self._light.undo(pixels)
        return replace(window, pixels=pixels)
