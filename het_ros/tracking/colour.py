# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much the colours of a place are the target's rather than the background's.

Shape features lose a target that bends, turns or is blurred; its colours stay. Two histograms,
of the target and of what surrounds it, give each pixel a probability of being the target's (Bayes
with equal priors), and the mean over a box of the target's size scores a place.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.gray import Plane, deviation

Corner = tuple[float, float]

_BITS = 4  # a channel: 16 x 16 x 16 bins of colour, or 16 x 16 of gray and its deviation
_AROUND = 7  # side of the square of that deviation, px ...
_DEVIATION_SCALE = 4.0  # ... which seldom exceeds 64 gray values
_EMPTY = 1e-4  # share of a bin below which little is known of its colour
_STRANGE = 0.2  # likelihood of a colour never seen: what comes in between is not the target
_CORE = 0.8  # the target's colours are taken from this part of the box: corners are background
_RING = 0.3  # width of the surroundings over half the target's circumference / 2


class ColourModel:
    """Colour histograms of a target and its surroundings.

    Args:
        size: (w, h) of the target, window px.
        learning_rate: weight of the new frame, 0..1.
    """

    def __init__(self, size: tuple[int, int], learning_rate: float) -> None:
        self._size = size
        self._learning_rate = learning_rate
        self._target: Plane | None = None
        self._around: Plane = np.empty(0, np.float32)
        self._pixels: NDArray[np.uint8] | None = None
        self._bins: NDArray[np.intp] = np.empty(0, np.intp)

    def likelihood(self, pixels: NDArray[np.uint8]) -> Plane:
        """Probability (H, W) float32 that a pixel is the target's, by its colour alone."""
        if self._target is None:
            raise RuntimeError("the colour model knows no target yet: call learn first")
        table = (self._target + _EMPTY) / (self._target + self._around + _EMPTY / _STRANGE)
        return np.asarray(table[self._bins_of(pixels)], np.float32)

    def learn(self, pixels: NDArray[np.uint8], corner: Corner) -> None:
        """Blend in the colours of a window with the target's corner at ``corner``, window px.

        The first call sets the histograms outright.

        Args:
            pixels: (H, W, 3) uint8 BGR or (H, W) uint8.
            corner: (x, y) of the target, window px.
        """
        bins = self._bins_of(pixels)
        width, height = self._size
        ring = round(_RING * (width + height) / 2)
        margin = (1 - _CORE) / 2
        target = _histogram(_cut(bins, corner, self._size, (-margin * width, -margin * height)))
        wide = _histogram(_cut(bins, corner, self._size, (ring, ring)))
        # Of a target of a few px the ring may be narrower than the px left out around it.
        around = np.maximum(wide - _histogram(_cut(bins, corner, self._size, (2, 2))), 0)
        target /= target.sum()
        around /= max(float(around.sum()), 1.0)
        if self._target is None:
            self._target, self._around = target, around
        else:
            self._target += self._learning_rate * (target - self._target)
            self._around += self._learning_rate * (around - self._around)

    def _bins_of(self, pixels: NDArray[np.uint8]) -> NDArray[np.intp]:
        """Bins of a window, which is asked for them once to judge and once to learn."""
        if pixels is not self._pixels:
            self._pixels, self._bins = pixels, colour_bins(pixels)
        return self._bins


def colour_bins(pixels: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Bin (H, W) of each pixel's colour, below 4096.

    A gray pixel's bin is that of its level and of how much the levels around it differ: the level
    alone tells a target from its surroundings far less well than a colour does.
    """
    if pixels.ndim == 2:
        differ = cv2.convertScaleAbs(deviation(pixels, _AROUND), alpha=_DEVIATION_SCALE)
        unused = 8 - _BITS
        both = pixels >> unused << _BITS | np.asarray(differ, np.uint8) >> unused
        return both.astype(np.intp)
    # The upper bits of each channel where they belong, in as few and as narrow passes as can be.
    upper = np.uint8(256 - (1 << 8 - _BITS))
    first = (pixels[..., 0] & upper).astype(np.uint16)
    first <<= np.uint16(3 * _BITS - 8)
    first |= (pixels[..., 1] & upper) >> np.uint8(8 - 2 * _BITS) | pixels[..., 2] >> np.uint8(
        8 - _BITS
    )
    return np.asarray(first, np.intp)


def cell_means(likelihood: Plane, cell: int) -> Plane:
    """Mean of a likelihood (H, W) over cells: (H // cell, W // cell) float32."""
    if cell == 1:
        return likelihood
    rows, columns = likelihood.shape[0] // cell, likelihood.shape[1] // cell
    whole = np.ascontiguousarray(likelihood[: rows * cell, : columns * cell])
    return np.asarray(cv2.resize(whole, (columns, rows), interpolation=cv2.INTER_AREA), np.float32)


def box_means(
    likelihood: Plane,
    size: tuple[int, int],
    shape: tuple[int, int],
    offset: Corner = (0.0, 0.0),
) -> Plane:
    """Mean likelihood in the boxes of ``size`` (w, h) with their corners at the first places.

    Args:
        likelihood: (H, W) float32.
        size: (w, h) of the target, px of ``likelihood``.
        shape: (rows, columns) of places asked for.
        offset: (x, y) of the boxes' corners from the places, px of ``likelihood``.
    """
    if offset != (0.0, 0.0):
        shift = np.array([[1, 0, -offset[0]], [0, 1, -offset[1]]])
        moved = cv2.warpAffine(
            likelihood, shift, likelihood.shape[::-1], borderMode=cv2.BORDER_REPLICATE
        )
        likelihood = np.asarray(moved, np.float32)
    means = cv2.boxFilter(
        likelihood, cv2.CV_32F, size, anchor=(0, 0), borderType=cv2.BORDER_REPLICATE
    )
    return np.asarray(means[: shape[0], : shape[1]], np.float32)


def _cut(
    bins: NDArray[np.intp], corner: Corner, size: tuple[int, int], margin: tuple[float, float]
) -> NDArray[np.intp]:
    """The part of a window within a box larger by ``margin`` on each side, 1 px or more."""
    ranges = []
    for start, length, more, limit in zip(corner, size, margin, bins.shape[::-1], strict=True):
        first = min(max(round(start - more), 0), limit - 1)
        last = min(max(round(start + length + more), first + 1), limit)
        ranges.append(slice(first, last))
    return bins[ranges[1], ranges[0]]


def _histogram(bins: NDArray[np.intp]) -> Plane:
    return np.bincount(bins.ravel(), minlength=1 << 3 * _BITS).astype(np.float32)
