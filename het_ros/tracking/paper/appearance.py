# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's "Local Compressive Appearance Model": sub-patches and what is seen of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Patch
from het_ros.tracking.features.channels import bgr_of, channel_stack, gray_of, names_for
from het_ros.tracking.features.compressive import (
    CompressiveFeatures,
    draw_measurement_matrix,
    integral_images,
)
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.features.window import Pixels, Window, cut_window
from het_ros.tracking.paper.config import PaperConfig

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SubPatches:
    """Layout of the sub-patches in the target, fixed at the first frame.

    Of a sub-patch <g, c, dp, p>, eq. (1) "patches", these are the size and dp. Its place p, its
    score c and its features g change with every frame: p follows from :meth:`corners`, c and g
    from the bottom layer.

    Attributes:
        size: (w, h) of every sub-patch, px.
        offsets: dp (Q, 2) float64: corner of a sub-patch relative to the target's, px.
    """

    size: tuple[int, int]
    offsets: Floats

    def corners(self, target: Floats) -> Floats:
        """Places p (Q, 2) of the sub-patches of a target whose corner is at (2,), px."""
        return target + self.offsets

    def in_image(self, window: Window, corners: Floats, weights: Floats) -> tuple[Patch, ...]:
        """The sub-patches where they were found, as boxes in image px.

        Args:
            window: that they were found in.
            corners: p (Q, 2), px of the window.
            weights: omega (Q,).
        """
        width, height = self.size
        centres = window.to_image(corners + np.array(self.size) / 2).tolist()
        return tuple(
            Patch(Box.from_centre(x, y, width, height), weight)
            for (x, y), weight in zip(centres, weights.tolist(), strict=True)
        )


def draw_sub_patches(
    target: tuple[float, float], count: int, fraction: float, rng: np.random.Generator
) -> SubPatches:
    """Lay out ``count`` sub-patches at random inside a target.

    Args:
        target: (w, h) of the target, px.
        count: Q.
        fraction: side of a sub-patch over the target's.
        rng: where the offsets are drawn from, uniformly among those inside the target.
    """
    width, height = (max(1, round(fraction * side)) for side in target)
    room = [max(0, int(target[0] - width)), max(0, int(target[1] - height))]
    offsets = rng.integers(0, room, size=(count, 2), endpoint=True).astype(np.float64)
    return SubPatches((width, height), offsets)


class LocalAppearance:
    """Turns images into frames of compressive features for one target.

    Args:
        config: parameters.
        target: (w, h) of the target, px.
        sub_patch: (w, h) of a sub-patch, px.
        gray: whether the target is followed without colour, as its first image has none.
        rng: where R is drawn from.

    Raises:
        ValueError: it would take more memory than ``most_memory``.
    """

    def __init__(
        self,
        config: PaperConfig,
        target: tuple[float, float],
        sub_patch: tuple[int, int],
        gray: bool,
        rng: np.random.Generator,
    ) -> None:
        self._gray = gray
        self._channels = names_for(config.channels, gray)
        # One px more than the search radius, as the window starts on a whole px.
        self._margin = math.ceil(config.search_radius) + 1
        self._target = np.array(target)
        width, height = (math.ceil(side) + 2 * self._margin for side in target)
        self._shape = width, height
        needed = _megabytes(config, width * height)
        if needed > config.most_memory:
            raise ValueError(
                f"the target takes {needed:.0f} MB with these parameters, most_memory is "
                f"{config.most_memory:g}: send a smaller box, or lower search_radius or features"
            )
        matrix = draw_measurement_matrix(
            sub_patch, len(self._channels), config.features, config.rectangles, rng
        )
        self._features = CompressiveFeatures(matrix)

    def frame(self, image: Pixels, centre: Floats) -> Frame:
        """The window with every place at which a sub-patch is looked for, and its features.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            centre: (x, y) of the target by the motion model, px.
        """
        x, y = (centre - (self._target / 2 + self._margin)).tolist()
        cut = cut_window(image, x, y, *self._shape)
        pixels = gray_of(cut.pixels) if self._gray else bgr_of(cut.pixels)
        channels = channel_stack(pixels, self._channels)
        maps = self._features.maps(integral_images(channels))
        return Frame.of(Window(pixels, cut.origin, cut.scale), channels, maps)


def _megabytes(config: PaperConfig, places: int) -> float:
    """About what window and maps take, MB; rather too much than too little.

    Args:
        config: parameters.
        places: number of px of the window.
    """
    # Bytes: three halves of float64 maps, scores and distances, integral images, the window.
    place = 12 * config.features + 16 * config.sub_patches + 16 * len(config.channels) + 16
    return (places * place + 16 * config.features**2) / 1e6
