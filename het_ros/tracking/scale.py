"""How much larger or smaller the target has become since the last frame.

A one-dimensional correlation filter over the target at S sizes around the present one: the sizes
are its "positions" (discriminative scale filter, after DSST: Danelljan et al., BMVC 2014). Its
features are means of the channels over a grid of rectangles that grows with the size; all of them
are read, with bilinear interpolation, from the frame's one set of integral images.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.subpixel import parabola_offset

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integrals = Sequence[NDArray[Any]]

_GRID = 8  # rectangles a side
_RIDGE = 0.01  # regularisation over the mean energy
_LABEL_SIGMA = 1.6  # deviation of the label, sizes


class ScaleFilter:
    """Finds the target's change of size and learns from where it was found.

    Args:
        size: (w, h) of the target at the present size, px of the integral images.
        levels: S, number of sizes tried.
        step: ratio of one size to the next.
        context: how much more than the target is looked at.
        learning_rate: weight of the new frame, 0..1.
    """

    def __init__(
        self,
        size: tuple[int, int],
        levels: int,
        step: float,
        context: float,
        learning_rate: float,
    ) -> None:
        self._size = np.array(size, np.float64) * context
        self._step = step
        self._learning_rate = learning_rate
        self._exponents = np.arange(levels) - (levels - 1) / 2
        self._label: Complex = np.fft.fft(np.exp(-0.5 * (self._exponents / _LABEL_SIGMA) ** 2))
        self._taper = np.hanning(levels + 2)[1:-1]
        self._mean: Floats | None = None  # (d, 1)
        self._weight: Floats = np.empty(0)  # (d, 1)
        self._numerator: Complex = np.empty(0, complex)  # (d, S)
        self._energy: Floats = np.empty(0)  # (S,)

    def change(self, integrals: Integrals, centre: Floats) -> float:
        """Ratio of the target's size in this frame to the present size.

        Args:
            integrals: C integral images (H + 1, W + 1).
            centre: (x, y) of the target, px of the integral images.
        """
        spectrum = np.fft.fft(self._features(integrals, centre, 1.0), axis=1)
        energy = self._energy + _RIDGE * self._energy.mean()
        response = np.fft.ifft((self._numerator * spectrum).sum(axis=0) / energy).real
        best = int(response.argmax())
        level = best + parabola_offset(response, best)
        return float(self._step ** (level - (len(self._exponents) - 1) / 2))

    def learn(self, integrals: Integrals, centre: Floats, ratio: float) -> None:
        """Learn the target at ``centre``, ``ratio`` times the present size; first call: outright.

        Args:
            integrals: C integral images (H + 1, W + 1).
            centre: (x, y) of the target, px of the integral images.
            ratio: what :meth:`change` said, as far as it was followed.
        """
        spectrum = np.fft.fft(self._features(integrals, centre, ratio), axis=1)
        numerator = self._label * np.conj(spectrum)
        energy = (np.abs(spectrum) ** 2).sum(axis=0)
        if not self._energy.size:
            self._numerator, self._energy = numerator, energy
            return
        self._numerator += self._learning_rate * (numerator - self._numerator)
        self._energy += self._learning_rate * (energy - self._energy)

    def _features(self, integrals: Integrals, centre: Floats, ratio: float) -> Floats:
        """(d, S): channel means over the grid at each size, centred, scaled and tapered."""
        sides = ratio * self._step ** self._exponents[:, None] * self._size  # (S, 2)
        features = grid_means(integrals, centre, sides, _GRID)
        if self._mean is None:
            self._mean = features.mean(axis=1, keepdims=True)
            deviation = features.reshape(len(integrals), -1).std(axis=1)
            self._weight = 1 / (np.repeat(deviation, _GRID**2)[:, None] + 1)
        return np.asarray((features - self._mean) * self._weight * self._taper)


def grid_means(integrals: Integrals, centre: Floats, sides: Floats, grid: int) -> Floats:
    """Means of channels over grids of rectangles of several sizes around one centre.

    Interpolating an integral image between its columns and rows is linear, so all sizes are read
    by two matrix products.

    Args:
        integrals: C integral images (H + 1, W + 1).
        centre: (x, y), px.
        sides: (S, 2), widths and heights of the grids, px; what lies outside counts as empty.
        grid: g, rectangles a side.

    Returns:
        (C g g, S) float64.
    """
    stack = np.stack(integrals).astype(np.float64)
    channels, height, width = stack.shape
    sizes = len(sides)
    lines = np.linspace(-0.5, 0.5, grid + 1)
    xs = np.clip(centre[0] + sides[:, :1] * lines, 0, width - 1)  # (S, g + 1)
    ys = np.clip(centre[1] + sides[:, 1:] * lines, 0, height - 1)
    # Differences of the narrow interpolation matrices, not of what they make of the stack.
    down = np.diff(_interpolation(ys.ravel(), height).reshape(sizes, grid + 1, height), axis=1)
    across = np.diff(_interpolation(xs.ravel(), width).reshape(sizes, grid + 1, width), axis=1)
    rows = down.reshape(-1, height) @ stack.transpose(1, 0, 2).reshape(height, -1)
    sums = rows.reshape(sizes, grid * channels, width) @ across.transpose(0, 2, 1)
    areas = np.diff(ys)[:, :, None] * np.diff(xs)[:, None, :] + 1e-3  # (S, g, g)
    means = sums.reshape(sizes, grid, channels, grid) / areas[:, :, None, :]
    return np.asarray(means.transpose(2, 1, 3, 0).reshape(channels * grid * grid, sizes))


def _interpolation(places: Floats, length: int) -> Floats:
    """(K, length): row k interpolates linearly at places[k] in 0..length - 1."""
    whole = np.minimum(places.astype(np.intp), length - 2)
    part = places - whole
    rows = np.arange(len(places))
    weights = np.zeros((len(places), length))
    weights[rows, whole] = 1 - part
    weights[rows, whole + 1] = part
    return weights
