"""The search window: the part of an image that a frame's work is done on."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]


@dataclass(frozen=True)
class Window:
    """A rectangle cut out of an image, at a resolution of its own.

    Attributes:
        pixels: (H, W, 3) or (H, W) uint8; a view of the image where that is possible.
        origin: image px (x, y) of the window's top-left corner, whole numbers.
        scale: window px per image px (in x, in y).
    """

    pixels: NDArray[np.uint8]
    origin: tuple[int, int]
    scale: tuple[float, float]

    def to_window(self, points: Points) -> Points:
        """Image px (..., 2) to window px (..., 2)."""
        return np.asarray((points - np.array(self.origin)) * np.array(self.scale))

    def to_image(self, points: Points) -> Points:
        """Window px (..., 2) to image px (..., 2)."""
        return np.asarray(points / np.array(self.scale) + np.array(self.origin))


def cut_window(
    image: NDArray[np.uint8], x: float, y: float, width: int, height: int, scale: float = 1.0
) -> Window:
    """Cut a window out of an image; only its own pixels are read, resized or copied.

    Args:
        image: (H, W, 3) or (H, W) uint8.
        x: wanted left side, image px; the window starts on the whole px at or before it.
        y: wanted top side, image px, likewise.
        width: width of the window, window px.
        height: height of the window, window px.
        scale: wanted window px per image px. The window's own ``scale`` differs from it by the
            rounding of its source to whole px.

    Returns:
        The window. Beyond the image's border the last pixel is repeated, also where the window
        lies wholly outside.
    """
    left, top = math.floor(x), math.floor(y)
    source_width, source_height = (
        (width, height) if scale == 1 else (math.ceil(width / scale), math.ceil(height / scale))
    )
    pixels = _crop(image, left, top, source_width, source_height)
    if (source_width, source_height) != (width, height):
        shrinks = source_width * source_height > width * height
        how = cv2.INTER_AREA if shrinks else cv2.INTER_LINEAR
        pixels = np.asarray(cv2.resize(pixels, (width, height), interpolation=how), np.uint8)
    return Window(pixels, (left, top), (width / source_width, height / source_height))


def _crop(
    image: NDArray[np.uint8], left: int, top: int, width: int, height: int
) -> NDArray[np.uint8]:
    """The rectangle of an image, its border repeated as far as needed."""
    rows, above, below = _inside(top, height, image.shape[0])
    columns, before, after = _inside(left, width, image.shape[1])
    part = image[rows, columns]
    if not (above or below or before or after):
        return part
    padded = cv2.copyMakeBorder(part, above, below, before, after, cv2.BORDER_REPLICATE)
    return np.asarray(padded, np.uint8)


def _inside(start: int, length: int, limit: int) -> tuple[slice, int, int]:
    """Of [start, start + length): the part in [0, limit), at least 1 px, and what pads it."""
    first = min(max(start, 0), limit - 1)
    last = min(max(start + length, 1), limit)
    before = min(max(-start, 0), length - 1)
    return slice(first, last), before, length - before - (last - first)
