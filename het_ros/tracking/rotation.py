# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How the target is turned in the image: by a camera that rolls, or on its own.

The features know one orientation. Search windows are cut out turned as the target is, once that
is more than the features bear anyway; below that a walker's gait would turn them to and fro.
Whoever looks more like the target upright than turned is upright: ``Target`` looks at both.
"""

from __future__ import annotations

import math

from het_ros.tracking.angle_filter import AngleFilter, Spectrum
from het_ros.tracking.frame import Floats
from het_ros.tracking.gray import Pixels

_ANGLE_GAIN, _SPIN_GAIN = 0.3, 0.03  # of an alpha-beta filter, a frame
_ANGLES_KNOWN = 15  # frames after which the angle filter has seen enough to be believed in full
_SPIN_KEPT = 0.9  # a frame
_LEAST_DT = 0.01  # s: stamps that come in bursts would make a spin of an error
_FASTEST = 2 * math.pi  # rad/s
_UPRIGHT = 0.015  # of the angle, a frame: who was upright at first mostly is ...
_UPRIGHT_WITHIN = math.radians(40)  # ... but who turns on and on is not held back any more
_HIDDEN_ANGLE_KEPT = 0.97  # a frame
_TURNED_FROM = math.radians(12)
_TURNED_STILL = math.radians(8.4)


class Rotation:
    """Follows the target's angle in the image plane.

    Args:
        width: of the target, px of the search window.
        height: of the target, px of the search window.

    Attributes:
        angle: rad, clockwise as one looks at the image: what windows are turned by.
    """

    def __init__(self, width: float, height: float) -> None:
        self.angle = 0.0
        self._filter = AngleFilter(width, height)
        self._spectrum: Spectrum | None = None
        self._estimate = 0.0  # rad
        self._spin = 0.0  # rad/s
        self._frames = 0

    def predict(self, dt: float) -> None:
        """Go on turning for ``dt`` s; sets ``angle``."""
        self._estimate = math.remainder(self._estimate + self._spin * dt, 2 * math.pi)
        least = _TURNED_STILL if self.angle else _TURNED_FROM
        self.angle = self._estimate if abs(self._estimate) >= least else 0.0

    def observe(self, pixels: Pixels, centre: Floats, dt: float) -> None:
        """Correct the angle by a frame in which the target was found.

        Args:
            pixels: (H, W, 3) uint8 BGR or (H, W) uint8, the window as it was cut out.
            centre: (x, y) of the target, px of it.
            dt: time since the last frame, s, positive.
        """
        self._spectrum = self._filter.spectrum(pixels, centre)
        seen = self.angle + self._filter.turn(self._spectrum)
        self._frames = min(self._frames + 1, _ANGLES_KNOWN)
        error = math.remainder(seen - self._estimate, 2 * math.pi)
        error *= self._frames / _ANGLES_KNOWN
        self._estimate += _ANGLE_GAIN * error
        within = min(max(self._estimate, -_UPRIGHT_WITHIN), _UPRIGHT_WITHIN)
        self._estimate -= _UPRIGHT * within
        spin = self._spin * _SPIN_KEPT + _SPIN_GAIN * error / max(dt, _LEAST_DT)
        self._spin = min(max(spin, -_FASTEST), _FASTEST)

    def learn(self, pixels: Pixels, centre: Floats) -> None:
        """Learn what the target looks like, turned as it was observed to be."""
        spectrum, self._spectrum = self._spectrum, None
        if spectrum is None:
            spectrum = self._filter.spectrum(pixels, centre)
        # Not as the filter says it is: it would go with its own errors.
        self._filter.learn(spectrum, self._estimate - self.angle)

    def forget(self) -> None:
        """The target is upright after all."""
        self._estimate = self._spin = self.angle = 0.0

    def coast(self) -> None:
        """The target is hidden: it turns on more slowly, and back to how it was at first."""
        self._estimate *= _HIDDEN_ANGLE_KEPT
        self._spin *= _SPIN_KEPT
        self._spectrum = None
