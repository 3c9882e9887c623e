# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much larger or smaller the target has become since the last frame.

A one-dimensional correlation filter over the target at S sizes around the present one: the sizes
are its "positions" (discriminative scale filter, after DSST: Danelljan et al., BMVC 2014). Its
features are means of the channels over a grid of rectangles that grows with the size, each px
counted with the part of it that a rectangle covers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.middle.grid_means import Features, Floats, Normalisation, grid_means
from het_ros.tracking.middle.running_mean import RunningMean
from het_ros.tracking.middle.voting import parabola_offset

Spectra = NDArray[np.complex64]


@dataclass(frozen=True)
class ScaleConfig:
    """Constants of the scale filter (after DSST, but where it says chosen).

    Attributes:
        levels: S, number of sizes tried; odd.
        step: ratio of one size to the next.
        context: how much more than the target is looked at (chosen).
        grid: rectangles across and down (chosen: 64 a channel).
        ridge: regularisation over the mean energy.
        label_sigma: deviation of the label, sizes.
    """

    levels: int = 17
    step: float = 1.02
    context: float = 1.2
    grid: tuple[int, int] = (8, 8)
    ridge: float = 0.01
    label_sigma: float = 1.6


class ScaleFilter:
    """Finds the target's change of size and learns from where it was found.

    Args:
        size: (w, h) of the target at the present size, px of the channels.
        rate: weight of the new frame, 0..1.
        first_frame: share of the first frame in what is learnt, which is never forgotten, 0..1.
    """

    def __init__(self, size: tuple[int, int], rate: float, first_frame: float) -> None:
        config = self._config = ScaleConfig()
        self._size = np.array(size, np.float64) * config.context
        self._exponents = np.arange(config.levels) - (config.levels - 1) / 2
        label = np.exp(-0.5 * (self._exponents / config.label_sigma) ** 2)
        self._label = np.fft.rfft(label).astype(np.complex64)
        self._to_spectrum = _tapered_transform(config.levels)
        self._normalisation = Normalisation()
        # Of the S frequencies of real features the first K = S // 2 + 1 say all.
        self._mean = RunningMean(rate, first_frame)  # numerator (d, K), energy (K,)

    def change(self, stack: Features, centre: Floats) -> float:
        """Ratio of the target's size in this frame to the present size.

        Args:
            stack: (H, C, W) float32, channels row by row.
            centre: (x, y) of the target, px of the channels.
        """
        spectrum = self._spectrum(stack, centre, 1.0)
        levels = len(self._exponents)
        numerator, energy = self._mean.values
        energy = energy + self._config.ridge * _mean_of_all(energy, levels)
        response = np.fft.irfft((numerator * spectrum).sum(axis=0) / energy, levels)
        best = int(response.argmax())
        level = best + parabola_offset(response, best)
        return float(self._config.step ** (level - (levels - 1) / 2))

    def learn(self, stack: Features, centre: Floats, ratio: float, weight: float) -> None:
        """Learn the target at ``centre``, ``ratio`` times the present size; first call: outright.

        Args:
            stack: (H, C, W) float32, channels row by row.
            centre: (x, y) of the target, px of the channels.
            ratio: what :meth:`change` said, as far as it was followed.
            weight: 0..1, of this frame.
        """
        spectrum = self._spectrum(stack, centre, ratio)
        parts = spectrum.view(np.float32)
        energy = np.einsum("dk,dk->k", parts, parts).reshape(-1, 2).sum(axis=1)
        numerator = np.conj(spectrum) * self._label
        self._mean.learn(numerator, energy.astype(np.float64), weight=weight)

    def _spectrum(self, stack: Features, centre: Floats, ratio: float) -> Spectra:
        """(d, K): channel means over the grid, centred and scaled, transformed over the sizes."""
        sides = ratio * self._config.step ** self._exponents[:, None] * self._size  # (S, 2)
        means = grid_means(stack, centre, sides, self._config.grid)  # (S, g, C, g)
        features = self._normalisation.features(means)
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
