# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How far the target's colours reach: a box of other width, height and place than the voted one.

Votes move a box of one shape. A target that bends or turns has another shape, which its colours
show: with the likelihood p of each px, the target is the rectangle with the largest sum of
p - 1/2. Its edges are found in one direction after the other. The colours of the given box seldom
fill it, so only the difference to the first frames counts; and only part of that is taken over,
by a regression on true boxes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.features.channels import Plane

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ExtentConfig:
    """Constants of the extent.

    Attributes:
        reach: how far from the voted edge the true one is looked for, target sides (chosen).
        rounds: over both directions (chosen: the second sees the first one's result).
        known: first frames, whose mean is what the given box looks like (chosen).
        rate: weight of a new frame in the running mean (chosen: three frames).
        shift, size: parts in x and y that are believed of the moved centre and of the
            logarithms of the sides (least squares on true boxes, leave-one-sequence-out).
    """

    reach: float = 0.45
    rounds: int = 2
    known: int = 8
    rate: float = 0.3
    shift: tuple[float, float] = (0.5, 0.15)
    size: tuple[float, float] = (0.3, 0.15)


class ColourExtent:
    """Follows how the colours' extent differs from the voted box."""

    def __init__(self) -> None:
        self._config = ExtentConfig()
        self._frames = 0
        self._given: Floats = np.zeros((2, 2))
        self._mean: Floats = np.zeros((2, 2))

    def follow(self, likelihood: Plane, corner: Floats, size: Floats) -> None:
        """Take in one frame.

        Args:
            likelihood: (H, W) float32, 0..1, that a px of the window is the target's.
            corner, size: (x, y) and (w, h) of the voted box, px of the window.
        """
        config, found = self._config, extent(likelihood, corner, size, self._config)
        if found is None:
            return
        if self._frames < config.known:
            self._frames += 1
            self._given = self._given + (found - self._given) / self._frames
        self._mean = self._mean + config.rate * (found - self._given - self._mean)

    def refined(self, box: Box) -> Box:
        """The box as far as its colours are believed to have another extent."""
        config = self._config
        (shift_x, shift_y), (wider, higher) = self._mean.tolist()
        x, y = box.centre
        return Box.from_centre(
            x + config.shift[0] * shift_x * box.w,
            y + config.shift[1] * shift_y * box.h,
            box.w * math.exp(config.size[0] * wider),
            box.h * math.exp(config.size[1] * higher),
        )


def extent(likelihood: Plane, corner: Floats, size: Floats, config: ExtentConfig) -> Floats | None:
    """The rectangle of the colours beside a box: [shift (x, y), logarithm of the ratio (w, h)].

    Shifts are in sides of the box. None where it lies outside the window or hardly anything is
    left of it.
    """
    gain = likelihood - np.float32(0.5)
    first, last = corner.copy(), corner + size
    for _ in range(config.rounds):
        for axis in (0, 1):
            other = 1 - axis
            lines = _whole(first[other], last[other], gain.shape[axis])
            if lines is None:
                return None
            band = gain[lines] if axis == 0 else gain[:, lines]
            total = np.concatenate([[0.0], np.cumsum(band.sum(axis=axis))])
            reach = config.reach * size[axis]
            low, high = corner[axis], corner[axis] + size[axis]
            first[axis] = _best(-total, low - reach, low + reach)
            last[axis] = _best(total, high - reach, high + reach)
    found = last - first
    if found.min() < 2:
        return None
    return np.stack([((first + last) / 2 - corner) / size - 0.5, np.log(found / size)])


def _whole(first: float, last: float, length: int) -> slice | None:
    """The whole px between two edges; None for fewer than two."""
    start, stop = max(0, round(first)), min(length, round(last))
    return slice(start, stop) if stop - start >= 2 else None


def _best(values: Floats, first: float, last: float) -> float:
    """Where, from ``first`` to ``last``, the largest of the values is."""
    start = min(max(0, round(first)), len(values) - 1)
    stop = max(start + 1, min(len(values), round(last) + 1))
    return float(start + int(values[start:stop].argmax()))
