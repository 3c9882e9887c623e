# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much larger or smaller the target has become since the last frame.

A one-dimensional correlation filter over the target at S sizes around the present one: the sizes
are its "positions" (discriminative scale filter, after DSST: Danelljan et al., BMVC 2014). Its
features are means of the channels over a grid of rectangles that grows with the size, each px
counted with the part of it that a rectangle covers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.subpixel import parabola_offset

Floats = NDArray[np.float64]
Features = NDArray[np.float32]
Spectra = NDArray[np.complex64]
Planes = Sequence[NDArray[Any]]

_GRID = 8  # rectangles a side
_RIDGE = 0.01  # regularisation over the mean energy
_LABEL_SIGMA = 1.6  # deviation of the label, sizes


class ScaleFilter:
    """Finds the target's change of size and learns from where it was found.

    Args:
        size: (w, h) of the target at the present size, px of the channels.
        levels: S, number of sizes tried.
        step: ratio of one size to the next.
        context: how much more than the target is looked at.
        learning_rate: weight of the new frame, 0..1.
        first_frame: share of the first frame in what is learnt, which is never forgotten, 0..1.
    """

    def __init__(
        self,
        size: tuple[int, int],
        levels: int,
        step: float,
        context: float,
        learning_rate: float,
        first_frame: float = 0.0,
    ) -> None:
        self._size = np.array(size, np.float64) * context
        self._step = step
        self._learning_rate = learning_rate
        self._first_frame = first_frame
        self._exponents = np.arange(levels) - (levels - 1) / 2
        self._label = np.fft.rfft(np.exp(-0.5 * (self._exponents / _LABEL_SIGMA) ** 2))
        self._to_spectrum = _tapered_transform(levels)
        self._mean: Features | None = None  # (d,)
        self._weight: Features = np.empty(0, np.float32)  # (d,)
        # Of the S frequencies of real features the first K = S // 2 + 1 say all.
        self._numerator: Spectra = np.empty(0, np.complex64)  # (d, K)
        self._energy: Floats = np.empty(0)  # (K,)
        self._first: tuple[Spectra, Floats] | None = None  # both of the first frame

    def change(self, planes: Planes, centre: Floats) -> float:
        """Ratio of the target's size in this frame to the present size.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.
        """
        spectrum = self._spectrum(planes, centre, 1.0)
        levels = len(self._exponents)
        energy = self._energy + _RIDGE * _mean_of_all(self._energy, levels)
        response = np.fft.irfft((self._numerator * spectrum).sum(axis=0) / energy, levels)
        best = int(response.argmax())
        level = best + parabola_offset(response, best)
        return float(self._step ** (level - (levels - 1) / 2))

    def learn(self, planes: Planes, centre: Floats, ratio: float) -> None:
        """Learn the target at ``centre``, ``ratio`` times the present size; first call: outright.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.
            ratio: what :meth:`change` said, as far as it was followed.
        """
        spectrum = self._spectrum(planes, centre, ratio)
        parts = spectrum.view(np.float32)
        energy = np.einsum("dk,dk->k", parts, parts).reshape(-1, 2).sum(axis=1)
        numerator = np.conj(spectrum) * self._label.astype(np.complex64)
        if self._first is None:
            self._numerator, self._energy = numerator, energy.astype(np.float64)
            self._first = self._numerator.copy(), self._energy
            return
        share = self._first_frame
        numerator = (1 - share) * numerator + share * self._first[0]
        energy = (1 - share) * energy + share * self._first[1]
        self._numerator *= 1 - self._learning_rate
        self._numerator += self._learning_rate * numerator
        self._energy = self._energy + self._learning_rate * (energy - self._energy)

    def _spectrum(self, planes: Planes, centre: Floats, ratio: float) -> Spectra:
        """(d, K): channel means over the grid, centred and scaled, transformed over the sizes."""
        sides = ratio * self._step ** self._exponents[:, None] * self._size  # (S, 2)
        means = grid_means(planes, centre, sides, _GRID)  # (S, g, C, g)
        features = means.reshape(len(sides), -1)
        if self._mean is None:
            self._mean = features.mean(axis=0)
            deviation = means.std(axis=(0, 1, 3))  # (C,)
            shape = means.shape[1:]
            self._weight = np.broadcast_to(1 / (deviation[:, None] + 1), shape).reshape(-1).copy()
        features -= self._mean
        features *= self._weight
        # What is real and what imaginary of a frequency lie next to each other.
        return np.asarray((features.T @ self._to_spectrum).view(np.complex64))


def _tapered_transform(levels: int) -> Features:
    """(S, 2 K): Hann window and Fourier transform of S numbers, real and imaginary in turns."""
    taper = np.hanning(levels + 2)[1:-1]
    transform = np.fft.rfft(np.diag(taper), axis=1)  # (S, K)
    return (
        np.stack([transform.real, transform.imag], axis=2).reshape(levels, -1).astype(np.float32)
    )


def _mean_of_all(half: Floats, levels: int) -> float:
    """Mean over all S frequencies of what is given (K,) for the first: the others mirror them."""
    mirrored = half[1 : (levels + 1) // 2]
    return float((half.sum() + mirrored.sum()) / levels)


def grid_means(planes: Planes, centre: Floats, sides: Floats, grid: int) -> Features:
    """Means of channels over grids of rectangles of several sizes around one centre.

    Which part of a px a rectangle covers is a product of a part in x and a part in y, so all
    sizes are read by two matrix products.

    Args:
        planes: C channels (H, W).
        centre: (x, y), px.
        sides: (S, 2), widths and heights of the grids, px; what lies outside counts as empty.
        grid: g, rectangles a side.

    Returns:
        (S, g, C, g) float32, the rectangles' rows in the second place, their columns in the last.
    """
    height, width = planes[0].shape
    sizes, channels = len(sides), len(planes)
    lines = np.linspace(-0.5, 0.5, grid + 1)
    xs = np.minimum(np.maximum(centre[0] + sides[:, :1] * lines, 0), width)  # (S, g + 1)
    ys = np.minimum(np.maximum(centre[1] + sides[:, 1:] * lines, 0), height)
    columns, across = _coverage(xs, width)
    rows, down = _coverage(ys, height)
    stack = np.empty((rows.stop - rows.start, channels, columns.stop - columns.start), np.float32)
    for channel, plane in enumerate(planes):
        stack[:, channel] = plane[rows, columns]
    strips = down.reshape(sizes * grid, -1) @ stack.reshape(len(stack), -1)
    # A copy of these few makes the product twice as fast.
    across = np.ascontiguousarray(across.transpose(0, 2, 1))
    sums = strips.reshape(sizes, grid * channels, -1) @ across
    areas = (ys[:, 1:] - ys[:, :-1])[:, :, None] * (xs[:, 1:] - xs[:, :-1])[:, None, :] + 1e-3
    means = sums.reshape(sizes, grid, channels, grid)
    means *= (1 / areas).astype(np.float32)[:, :, None, :]
    return np.asarray(means)


def _coverage(lines: Floats, length: int) -> tuple[slice, Features]:
    """Part of each px of an axis that lies between one line and the next.

    Args:
        lines: (S, g + 1), within 0..length.
        length: of the axis, px.

    Returns:
        The range of px that is covered at all, one or more, and (S, g, px) for these.
    """
    first = min(int(lines.min()), length - 1)
    last = max(first + 1, int(np.ceil(lines.max())))
    # Between 0 and 1, which is all that is left of it, float32 says it well enough.
    before = (lines[:, :, None] - np.arange(first, last)).astype(np.float32)
    np.minimum(np.maximum(before, 0, out=before), 1, out=before)
    return slice(first, last), before[:, 1:] - before[:, :-1]
