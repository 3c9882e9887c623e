# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Made frames of any size: a texture with detail at every scale that moves past the camera."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box

Image = NDArray[np.uint8]
STEP = 2  # px a frame


class Footage:
    """A texture that moves forth and back, ``STEP`` px a frame in x.

    Every frame is an array of its own, as a camera delivers them: a tracker does not find its
    pixels in the processor's cache.

    Args:
        width: of the frames, px.
        height: likewise.
        count: number of different frames; after the last they come in reverse.
        seed: of the texture.
    """

    def __init__(self, width: int, height: int, count: int = 4, seed: int = 0) -> None:
        wide = _texture(width + STEP * (count - 1), height, seed)
        self._frames = [
            np.ascontiguousarray(wide[:, STEP * i : STEP * i + width]) for i in range(count)
        ]

    def __len__(self) -> int:
        """Number of different frames."""
        return len(self._frames)

    def at(self, index: int) -> int:
        """Which of the different frames comes at a place in the endless stream, 0...

        >>> [Footage(8, 8, 3).at(i) for i in range(6)]
        [0, 1, 2, 1, 0, 1]
        """
        period = max(1, 2 * (len(self) - 1))
        place = index % period
        return min(place, period - place)

    def __getitem__(self, index: int) -> Image:
        """Frame (H, W, 3) uint8 BGR of the endless stream, counted from 0."""
        return self._frames[self.at(index)]


def middle(footage: Footage, target: tuple[int, int]) -> Box:
    """A box of that size (w, h), px, in the middle of the frames."""
    height, width = footage[0].shape[:2]
    return Box.from_centre(width / 2, height / 2, *target)


def _texture(width: int, height: int, seed: int) -> Image:
    """Coloured noise (H, W, 3) uint8, octaves of equal strength from 3 px on."""
    rng = np.random.default_rng(seed)
    total = np.zeros((height, width, 3), np.float32)
    side = 3.0
    octaves = 0
    while side < width / 4:
        cells = (max(2, round(height / side)), max(2, round(width / side)), 3)
        noise = rng.standard_normal(cells).astype(np.float32)
        total += cv2.resize(noise, (width, height), interpolation=cv2.INTER_LINEAR)
        side *= 2
        octaves += 1
    total *= 55 / np.sqrt(max(octaves, 1))
    return np.asarray(np.clip(total + 128, 0, 255), np.uint8)
