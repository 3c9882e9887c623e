# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How a target moves, and where that takes it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """What is known of a target's motion.

    Attributes:
        steady, brief: (D,), px/s: their sum is the velocity.
        covariance: (D, D) of the sum, px^2/s^2.
        steady_time, brief_time: s, in which they fall to 1/e.
        acceleration: white, px/s^1.5: by which a prediction becomes unsure.
    """

    steady: Floats
    brief: Floats
    covariance: Floats
    steady_time: float
    brief_time: float
    acceleration: float

    @property
    def total(self) -> tuple[float, float]:
        """(vx, vy), px/s."""
        velocity = (self.steady + self.brief).tolist()
        return velocity[0], velocity[1]

    def later(self, dt: float) -> Motion:
        """The same motion, ``dt`` s later."""
        fading = math.exp(-dt / self.steady_time)
        spread = fading**2 * self.covariance + self.acceleration**2 * dt * np.eye(len(self.steady))
        return Motion(
            fading * self.steady,
            math.exp(-dt / self.brief_time) * self.brief,
            spread,
            self.steady_time,
            self.brief_time,
            self.acceleration,
        )

    def way(self, dt: float) -> Floats:
        """(D,), px: how far the target goes in ``dt`` s."""
        return (
            way_of(self.steady_time, dt) * self.steady + way_of(self.brief_time, dt) * self.brief
        )

    def way_covariance(self, dt: float) -> Floats:
        """(D, D), px^2: of :meth:`way`."""
        unsure = way_of(self.steady_time, dt) ** 2 * self.covariance
        return np.asarray(unsure + self.acceleration**2 * dt**3 / 3 * np.eye(len(self.steady)))


def way_of(fading: float, dt: float) -> float:
    """How far a velocity of 1 goes in ``dt`` s that falls to 1/e in ``fading`` s."""
    return fading * (1 - math.exp(-dt / fading))
