# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Means of channels over grids of rectangles, read at any size and place between whole px."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Features = NDArray[np.float32]


def grid_means(stack: Features, centre: Floats, sides: Floats, grid: tuple[int, int]) -> Features:
    """Means of channels over grids of rectangles of several sizes.

    Which part of a px a rectangle covers is a product of a part in x and a part in y, so all
    sizes are read by two matrix products.

    Args:
        stack: (H, C, W) float32, C channels row by row.
        centre: (x, y) of all grids or (S, 2) of each, px.
        sides: (S, 2), widths and heights of the grids, px; what lies outside counts as empty.
        grid: (a, b), rectangles across and down.

    Returns:
        (S, b, C, a) float32, the rectangles' rows in the second place, their columns in the last.
    """
    height, channels, width = stack.shape
    sizes = len(sides)
    xs = centre[..., :1] + sides[:, :1] * _lines(grid[0])  # (S, a + 1)
    ys = centre[..., 1:] + sides[:, 1:] * _lines(grid[1])
    xs = np.minimum(np.maximum(xs, 0), width)
    ys = np.minimum(np.maximum(ys, 0), height)
    top = min(int(ys.min()), height - 1)
    rows = stack[top : max(top + 1, math.ceil(ys.max()))]
    down = _coverage(ys - top, len(rows)).reshape(sizes * grid[1], -1)
    strips = (down @ rows.reshape(len(rows), -1)).reshape(sizes, grid[1] * channels, width)
    # A copy of these few makes the product twice as fast.
    across = np.ascontiguousarray(_coverage(xs, width).transpose(0, 2, 1))
    means = (strips @ across).reshape(sizes, grid[1], channels, grid[0])
    areas = (ys[:, 1:] - ys[:, :-1])[:, :, None] * (xs[:, 1:] - xs[:, :-1])[:, None, :] + 1e-3
    means *= (1 / areas).astype(np.float32)[:, :, None, :]
    return np.asarray(means)


class Normalisation:
    """Mean and deviation of a target's first grid means, by which all are normalised.

    Each value is taken less its mean over the first grids, and over the deviation of its channel
    there. What is flat would say too much: one level is added to the deviation.
    """

    def __init__(self) -> None:
        self._mean: Features | None = None  # (d,)
        self._weight: Features = np.empty(0, np.float32)  # (d,)

    def features(self, means: Features) -> Features:
        """(S, d) float32 of grid means (S, b, C, a), d = b C a; those of the first call set it."""
        flat = means.reshape(len(means), -1)
        if self._mean is None:
            self._mean = flat.mean(axis=0)
            deviation = means.std(axis=(0, 1, 3))[:, None]  # (C, 1)
            self._weight = np.broadcast_to(1 / (deviation + 1), means.shape[1:]).ravel()
        features = flat - self._mean
        features *= self._weight
        return features


@cache
def _lines(parts: int) -> Floats:
    """(parts + 1,) places of the lines that divide a side of 1 around 0."""
    return np.linspace(-0.5, 0.5, parts + 1)


def _coverage(lines: Floats, length: int) -> Features:
    """Part of each px of an axis that lies between one line and the next: (S, g, length).

    Args:
        lines: (S, g + 1), within 0..length.
        length: of the axis, px.
    """
    # Between 0 and 1, which is all that is left of it, float32 says it well enough.
    before = np.subtract.outer(lines, np.arange(length)).astype(np.float32)
    np.minimum(np.maximum(before, 0, out=before), 1, out=before)
    return np.asarray(before[:, 1:] - before[:, :-1])
