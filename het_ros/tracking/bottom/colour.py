# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much the colours of a place are the target's rather than the background's.

Shape features lose a target that bends, turns or is blurred; its colours stay. Two histograms,
of the target and of what surrounds it, give each pixel a probability of being the target's (Bayes
with equal priors), and the mean over a box of the target's size scores a place.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.ensemble import Look
from het_ros.tracking.box import Box
from het_ros.tracking.features.channels import Pixels, Plane, deviation

Corner = tuple[float, float]
UNTAUGHT = "the colour model knows no target yet: call learn first"


@dataclass(frozen=True)
class ColourConfig:
    """Constants of the histograms; all chosen.

    Attributes:
        bits: a channel: 16 x 16 x 16 bins of colour, or 16 x 16 of gray and its deviation.
        around: side of the square that a gray pixel's deviation is taken from, px.
        deviation_scale: that deviation, which seldom exceeds 64 gray values, fills a byte.
        empty: share of a bin below which little is known of its colour.
        strange: likelihood of a colour never seen: what comes in between is not the target.
        core: the target's colours are taken from this part of the box; corners are background.
        ring: width of the surroundings over the target's mean side.
    """

    bits: int = 4
    around: int = 7
    deviation_scale: float = 4.0
    empty: float = 1e-4
    strange: float = 0.2
    core: float = 0.8
    ring: float = 0.3


class ColourEnsemble:
    """Colour histograms of a target and its surroundings.

    Args:
        size: (w, h) of the target, working px.
        cell: side of a cell, working px.
        rate: weight of the new frame, 0..1.

    Attributes:
        seen: (H, W) float32, likelihood of each px of the window in the last vote.
    """

    def __init__(self, size: tuple[int, int], cell: int, rate: float) -> None:
        self._config = ColourConfig()
        self._size, self._cell, self._rate = size, cell, rate
        self._target: Plane | None = None
        self._usual = 1.0
        self._around: Plane = np.empty(0, np.float32)
        self.seen: Plane = np.empty((0, 0), np.float32)
        # A window is asked for its bins twice a frame, to vote and to learn.
        self._pixels: Pixels | None = None
        self._bins: NDArray[np.intp] = np.empty(0, np.intp)

    def vote(self, look: Look) -> Plane:
        """Mean likelihood in a box of the target's size at each place, 0..1."""
        self.seen = self.likelihood(look.frame.window.pixels)
        return box_means(cell_means(self.seen, self._cell), look.cells, look.places)

    def learn(self, look: Look, box: Box, weight: float) -> None:
        """Take in the target in ``box``, image px; see :class:`BaseEnsemble`."""
        if weight > 0:
            self.learn_pixels(look.frame.window.pixels, self._corner(look, box), weight)

    def similarity(self, look: Look, box: Box) -> float:
        """How much the colours in ``box``, image px, are those of the target: about 1 for itself.

        The Bhattacharyya coefficient of both histograms, in which colours count by how much they
        are the target's alone, over its own average. Unlike :meth:`likelihood` it tells the
        target from what is in no way like its surroundings either: somebody else.

        Raises:
            RuntimeError: nothing was learnt.
        """
        if self._target is None:
            raise RuntimeError(UNTAUGHT)
        there = self._core(self._bins_of(look.frame.window.pixels), self._corner(look, box))
        return self._coefficient(there, self._target) / self._usual

    def forget(self) -> None:
        """Nothing of one frame is kept."""

    def likelihood(self, pixels: Pixels) -> Plane:
        """Probability (H, W) float32 that a pixel is the target's, by its colour alone.

        Raises:
            RuntimeError: nothing was learnt.
        """
        if self._target is None:
            raise RuntimeError(UNTAUGHT)
        return np.asarray(self._own(self._target)[self._bins_of(pixels)], np.float32)

    def learn_pixels(self, pixels: Pixels, corner: Corner, weight: float) -> None:
        """Blend in the colours of a window with the target's corner at ``corner``, window px.

        The first call sets the histograms outright.

        Args:
            pixels: (H, W, 3) uint8 BGR or (H, W) uint8.
            corner: (x, y) of the target, window px.
            weight: 0..1, of this frame.
        """
        bins = self._bins_of(pixels)
        width, height = self._size
        ring = round(self._config.ring * (width + height) / 2)
        target = self._core(bins, corner)
        wide = _histogram(_cut(bins, corner, self._size, (ring, ring)))
        # Of a target of a few px the ring may be narrower than the px left out around it.
        around = np.maximum(wide - _histogram(_cut(bins, corner, self._size, (2, 2))), 0)
        around /= max(float(around.sum()), 1.0)
        if self._target is None:
            self._target, self._around = target, around
        else:
            rate = self._rate * weight
            self._usual += rate * (self._coefficient(target, self._target) - self._usual)
            self._target = self._target + rate * (target - self._target)
            self._around = self._around + rate * (around - self._around)

    def _corner(self, look: Look, box: Box) -> Corner:
        """(x, y) of the target in ``box``, window px."""
        x, y = (look.corner_of(np.array(box.centre)) * self._cell).tolist()
        return x, y

    def _own(self, target: Plane) -> Plane:
        """Probability of each colour that it is the target's, not that of its surroundings."""
        empty, strange = self._config.empty, self._config.strange
        return np.asarray((target + empty) / (target + self._around + empty / strange))

    def _coefficient(self, there: Plane, target: Plane) -> float:
        """Similarity of two histograms of sum 1: 1 where they are equal."""
        own = self._own(target)
        return float((own * np.sqrt(there * target)).sum() / (own * target).sum())

    def _core(self, bins: NDArray[np.intp], corner: Corner) -> Plane:
        """The histogram, of sum 1, of a target with its corner there, window px."""
        width, height = self._size
        margin = (1 - self._config.core) / 2
        inside = _histogram(_cut(bins, corner, self._size, (-margin * width, -margin * height)))
        return np.asarray(inside / inside.sum(), np.float32)

    def _bins_of(self, pixels: Pixels) -> NDArray[np.intp]:
        if pixels is not self._pixels:
            self._pixels, self._bins = pixels, colour_bins(pixels)
        return self._bins


def colour_bins(pixels: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Bin (H, W) of each pixel's colour, below 4096.

    A gray pixel's bin is that of its level and of how much the levels around it differ: the level
    alone tells a target from its surroundings far less well than a colour does.
    """
    config = ColourConfig()
    bits, unused = config.bits, 8 - config.bits
    if pixels.ndim == 2:
        around = deviation(pixels, config.around)
        differ = cv2.convertScaleAbs(around, alpha=config.deviation_scale)
        both = pixels >> unused << bits | np.asarray(differ, np.uint8) >> unused
        return both.astype(np.intp)
    # The upper bits of each channel where they belong, in as few and as narrow passes as can be.
    upper = np.uint8(256 - (1 << unused))
    first = (pixels[..., 0] & upper).astype(np.uint16)
    first <<= np.uint16(3 * bits - 8)
    first |= (pixels[..., 1] & upper) >> np.uint8(8 - 2 * bits) | pixels[..., 2] >> np.uint8(
        unused
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
) -> Plane:
    """Mean likelihood in the boxes of ``size`` (w, h) with their corners at the first places.

    Args:
        likelihood: (H, W) float32.
        size: (w, h) of the target, px of ``likelihood``.
        shape: (rows, columns) of places asked for.
    """
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
    return np.bincount(bins.ravel(), minlength=1 << 3 * ColourConfig().bits).astype(np.float32)
