# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How far the target is turned in the image from what was learnt of it.

A correlation filter over angles, as ``scale.py`` has one over sizes: sampled on circles around its
centre, a turned target is a shifted one (the log-polar idea of LDES: Li, Zhu, Hoi, Song, Wang,
AAAI 2019, without its logarithm). All angles are there, so that the shift wraps around and the
Fourier transform needs no taper. What lies outside the target's ellipse counts little, since the
surroundings do not turn with it.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.gray import Pixels
from het_ros.tracking.memory import Memory
from het_ros.tracking.subpixel import parabola_offset

Floats = NDArray[np.float64]
Spectrum = NDArray[np.complex128]

ANGLES, _RINGS = 64, 12
STEP = 2 * math.pi / ANGLES  # rad, from one angle to the next
_FINER = 2  # samples a side for each of these
_REACH = 0.6  # radius of the circles: this much of the target's side, ...
_BY_LONGEST = 0.75  # ... as it is between sqrt(w h) and the longer one
_ELLIPSE = 1.2  # times the target: inside it counts in full, ...
_OUTSIDE = 0.1  # ... outside so much
_EDGE = 6.0  # how sharply
_FARTHEST = 4  # steps a frame
_LABEL_SIGMA = 1.2  # steps
_RIDGE = 0.01  # regularisation over the mean energy
_NOTHING = 1e-9  # energy of a flat picture, which says nothing
_RATE = 0.03  # weight of a new frame
_FIRST_FRAME = 0.1  # share of the first frame, which is never forgotten
_APART = np.minimum(np.arange(ANGLES), ANGLES - np.arange(ANGLES))
_LABEL = np.fft.rfft(np.exp(-0.5 * (_APART / _LABEL_SIGMA) ** 2))[:, None]  # (K, 1)


class AngleFilter:
    """Finds the target's turn and learns what it looks like all around.

    Args:
        width: of the target, px of the search window.
        height: of the target, px of the search window.
    """

    def __init__(self, width: float, height: float) -> None:
        side = (1 - _BY_LONGEST) * math.sqrt(width * height) + _BY_LONGEST * max(width, height)
        radius = _REACH * side
        self._places = _circles(_FINER * ANGLES, _FINER * _RINGS, radius)
        x, y = _circles(ANGLES, _RINGS, radius)
        distance = np.hypot(2 * x / (_ELLIPSE * width), 2 * y / (_ELLIPSE * height))
        inside = 1 / (1 + np.exp(np.minimum(_EDGE * (distance - 1), 50.0)))
        # An outer ring is longer than an inner one; the innermost is a point that turns nowhere.
        weight = (_OUTSIDE + (1 - _OUTSIDE) * inside) * np.sqrt(np.arange(_RINGS))
        self._weight = weight[:, 1:, None]
        # Numerator (K, d) and energy (K,), K = ANGLES // 2 + 1.
        self._memory = Memory(_RATE, _FIRST_FRAME)

    def spectrum(self, pixels: Pixels, centre: Floats) -> Spectrum:
        """(K, d): what is around ``centre``, transformed over the angles.

        Args:
            pixels: (H, W, 3) uint8 BGR or (H, W) uint8, the search window.
            centre: (x, y) of the target, px; a px's place is its corner.
        """
        x, y = (
            np.asarray(plane + (float(at) - 0.5), np.float32)
            for plane, at in zip(self._places, centre, strict=True)
        )
        around = cv2.remap(pixels, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        planes = _planes(np.asarray(around, np.uint8))
        means = cv2.resize(planes, (_RINGS, ANGLES), interpolation=cv2.INTER_AREA)
        features = np.asarray(means, np.float64).reshape(ANGLES, _RINGS, -1)[:, 1:]
        features = features - features.mean(axis=0)
        features *= self._weight / (features.std(axis=(0, 1)) + 1)
        return np.asarray(np.fft.rfft(features.reshape(ANGLES, -1), axis=0))

    def turn(self, spectrum: Spectrum) -> float:
        """rad: how far the target is turned in the window, clockwise, up to 4 steps.

        Raises:
            RuntimeError: nothing was learnt.
        """
        if not self._memory:
            raise RuntimeError("there is no target to compare with: call learn first")
        numerator, energy = self._memory.values
        energy = energy + _RIDGE * energy.mean() + _NOTHING
        response = np.fft.irfft((numerator * spectrum).sum(axis=1) / energy, ANGLES)
        near = np.roll(response, _FARTHEST + 1)[: 2 * _FARTHEST + 3]
        best, straight = 1 + int(near[1:-1].argmax()), _FARTHEST + 1
        if near[best] <= near[straight]:
            best = straight  # where all angles are alike, too
        return float(best - straight + parabola_offset(near, best)) * STEP

    def learn(self, spectrum: Spectrum, turn: float) -> None:
        """Learn the target as turned by ``turn``, rad; the first call learns it outright."""
        frequencies = np.arange(len(spectrum))[:, None]
        straight = spectrum * np.exp(1j * turn * frequencies)
        numerator = np.conj(straight) * _LABEL
        energy = (np.abs(straight) ** 2).sum(axis=1)
        self._memory.learn(numerator, energy)


def _circles(angles: int, rings: int, radius: float) -> tuple[Floats, Floats]:
    """(angles, rings) x and (angles, rings) y of places on circles around the origin."""
    # The samples of a step lie around its middle, so that coarse ones are means of finer ones.
    turns = (np.arange(angles) + 0.5) * 2 * math.pi / angles
    radii = (np.arange(rings) + 0.5) * radius / rings
    return np.outer(np.cos(turns), radii), np.outer(np.sin(turns), radii)


def _planes(around: Pixels) -> NDArray[np.float32]:
    """(H, W, C) float32: lightness, two of colour where there is any, and the gradient."""
    colour = around.ndim == 3
    planes = np.asarray(cv2.cvtColor(around, cv2.COLOR_BGR2LAB) if colour else around[..., None])
    lightness = np.ascontiguousarray(planes[..., 0])
    # Angles wrap around, so what lies beyond the first is the last.
    wrapped = cv2.copyMakeBorder(lightness, 1, 1, 0, 0, cv2.BORDER_WRAP)
    across = cv2.Sobel(wrapped, cv2.CV_32F, 1, 0)[1:-1]
    along = cv2.Sobel(wrapped, cv2.CV_32F, 0, 1)[1:-1]
    return np.dstack([planes.astype(np.float32), cv2.magnitude(across, along)])
