# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much larger or smaller the target has become since the last frame.

A one-dimensional correlation filter over the target at S sizes around the present one: the sizes
are its "positions" (discriminative scale filter, after DSST: Danelljan et al., BMVC 2014). Its
features are means of the channels over a grid of rectangles that grows with the size, each px
counted with the part of it that a rectangle covers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.grid_means import Features, Floats, Planes, Standard, grid_means
from het_ros.tracking.memory import Memory
from het_ros.tracking.subpixel import parabola_offset

Spectra = NDArray[np.complex64]

_GRID = 8, 8  # rectangles across and down
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
        self._exponents = np.arange(levels) - (levels - 1) / 2
        self._label = np.fft.rfft(np.exp(-0.5 * (self._exponents / _LABEL_SIGMA) ** 2))
        self._to_spectrum = _tapered_transform(levels)
        self._standard = Standard()
        # Of the S frequencies of real features the first K = S // 2 + 1 say all.
        self._memory = Memory(learning_rate, first_frame)  # numerator (d, K), energy (K,)

    def change(self, planes: Planes, centre: Floats) -> float:
        """Ratio of the target's size in this frame to the present size.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.
        """
        spectrum = self._spectrum(planes, centre, 1.0)
        levels = len(self._exponents)
        numerator, energy = self._memory.values
        energy = energy + _RIDGE * _mean_of_all(energy, levels)
        response = np.fft.irfft((numerator * spectrum).sum(axis=0) / energy, levels)
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
        self._memory.learn(numerator, energy.astype(np.float64))

    def _spectrum(self, planes: Planes, centre: Floats, ratio: float) -> Spectra:
        """(d, K): channel means over the grid, centred and scaled, transformed over the sizes."""
        sides = ratio * self._step ** self._exponents[:, None] * self._size  # (S, 2)
        means = grid_means(planes, centre, sides, _GRID)  # (S, g, C, g)
        features = self._standard.features(means)
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
