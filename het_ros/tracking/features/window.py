# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The search window: the part of an image that a frame's work is done on."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
Points = NDArray[np.float64]


@dataclass(frozen=True)
class SamplingConfig:
    """Constants of the window's resolution.

    Attributes:
        average_from: a window that shrinks its source by more is averaged, not interpolated
            (chosen: bilinear interpolation reads 2 px a side, so from about there on it skips
            some).
        samples: of a source that is larger still, only every k-th px is read, so that each
            window px averages this many px a side (chosen: the cost of a window then does not
            depend on the target's size).
    """

    average_from: float = 1.5
    samples: int = 3


@dataclass(frozen=True)
class Window:
    """An upright rectangle cut out of an image, at a resolution of its own.

    Attributes:
        pixels: (H, W, 3) or (H, W) uint8; a view of the image where that is possible.
        origin: image px (x, y) of the window's top-left corner.
        scale: window px per image px (in x, in y).
    """

    pixels: Pixels
    origin: tuple[float, float]
    scale: tuple[float, float]

    def to_window(self, points: Points) -> Points:
        """Image px (..., 2) to window px (..., 2)."""
        return np.asarray((points - np.array(self.origin)) * self.scale)

    def to_image(self, points: Points) -> Points:
        """Window px (..., 2) to image px (..., 2)."""
        return np.asarray(points / np.array(self.scale) + self.origin)

    def in_cells(self, cell: float) -> Window:
        """The same window with places counted in cells of ``cell`` px."""
        return replace(self, scale=(self.scale[0] / cell, self.scale[1] / cell))


def cut_window(
    image: Pixels,
    x: float,
    y: float,
    width: int,
    height: int,
    scale: tuple[float, float] = (1.0, 1.0),
) -> Window:
    """Cut a window out of an image; only its own pixels are read, resized or copied.

    Args:
        image: (H, W, 3) or (H, W) uint8.
        x: top-left corner, image px. At scale 1 the window starts on the whole px at or before
            it.
        y: the same corner, image px, likewise.
        width: width of the window, window px.
        height: height of the window, window px.
        scale: window px per image px (in x, in y).

    Returns:
        The window. Beyond the image's border the last pixel is repeated, also where the window
        lies wholly outside.
    """
    if scale == (1.0, 1.0):
        left, top = math.floor(x), math.floor(y)
        return Window(_crop(image, left, top, width, height), (left, top), scale)
    return Window(_resample(image, x, y, width, height, scale), (x, y), scale)


def _crop(image: Pixels, left: int, top: int, width: int, height: int) -> Pixels:
    """The rectangle of an image, its border repeated as far as needed."""
    rows, above, below = _inside(top, height, image.shape[0])
    columns, before, after = _inside(left, width, image.shape[1])
    part = image[rows, columns]
    if not (above or below or before or after):
        return part
    padded = cv2.copyMakeBorder(part, above, below, before, after, cv2.BORDER_REPLICATE)
    return np.asarray(padded, np.uint8)


def _resample(
    image: Pixels, x: float, y: float, width: int, height: int, scale: tuple[float, float]
) -> Pixels:
    """The window at a resolution of its own, its corner at (x, y) to a fraction of a px."""
    columns = _inside(math.floor(x) - 1, math.ceil(width / scale[0]) + 3, image.shape[1])[0]
    rows = _inside(math.floor(y) - 1, math.ceil(height / scale[1]) + 3, image.shape[0])[0]
    source, coarse = _averaged(image[rows, columns], scale)
    step = np.array([1 / scale[0], 1 / scale[1]])
    # The centre of the window's first px, in source px from the corner of the first one.
    first = step / 2 + (x - columns.start, y - rows.start)
    to_source = np.column_stack([np.diag(step), first]) / coarse[:, None] - [[0, 0, 0.5]]
    resampled = cv2.warpAffine(
        source,
        to_source,
        (width, height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )
    return np.asarray(resampled, np.uint8)


def _averaged(source: Pixels, scale: tuple[float, float]) -> tuple[Pixels, Points]:
    """The source at about the window's resolution where that is much coarser.

    Returns:
        The source, and how many image px one px of it stands for, (2,), in x and in y.
    """
    shrink = 1 / min(scale)
    if shrink <= SamplingConfig().average_from:
        return source, np.ones(2)
    rows, columns = source.shape[:2]
    size = max(1, round(columns * scale[0])), max(1, round(rows * scale[1]))
    thinned = _thinned(source, max(1, int(shrink / SamplingConfig().samples)))
    averaged = cv2.resize(thinned, size, interpolation=cv2.INTER_AREA)
    return np.asarray(averaged, np.uint8), np.array([columns / size[0], rows / size[1]])


def _thinned(source: Pixels, step: int) -> Pixels:
    """Every ``step``-th px of every ``step``-th row, faster than by copying a slice."""
    if step == 1:
        return np.ascontiguousarray(source)  # which OpenCV shrinks faster
    # From the middle of each step on, or everything would move by half a step.
    top, left = (min(step // 2, side - 1) for side in source.shape[:2])
    rest = source[top:, left:]
    rows, columns = (-(-side // step) for side in rest.shape[:2])
    to_source = np.diag([float(step), step, 1])[:2]
    flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
    return np.asarray(cv2.warpAffine(rest, to_source, (columns, rows), flags=flags), np.uint8)


def _inside(start: int, length: int, limit: int) -> tuple[slice, int, int]:
    """Of [start, start + length): the part in [0, limit), at least 1 px, and what pads it."""
    first = min(max(start, 0), limit - 1)
    last = min(max(start + length, 1), limit)
    before = min(max(-start, 0), length - 1)
    return slice(first, last), before, length - before - (last - first)
