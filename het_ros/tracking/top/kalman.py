# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Top layer: the adaptive Kalman filter over the target's centre."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_STEADY_TIME = 0.4  # s, over which velocities are averaged for coasting
_COAST_TIME = 0.5  # s, in which a hidden target's velocity falls to 1/e


class AdaptiveKalman:
    """Constant-velocity filter over x = [cx, cy, vx, vy], px and px/s (eq. Kalman(k+1)).

    The measurement is the target's centre, so B is 2 x 4 (the paper prints the 2 x 2 identity).
    The noises follow the mean weight of the sub-patches (eqs. Q_update, R_update). All noises are
    the same in x and y, which so share one 2 x 2 covariance and one gain: a few lines of NumPy
    here, where the import of a library's filter costs 0.7 s and 70 MB (``paper/`` has it).

    Args:
        centre: (cx, cy) of the first frame, px.
        acceleration: deviation of the acceleration, px/s^2. Q(0) is what white acceleration
            of that size adds over a step.
        measurement_noise: deviation of a measurement, px. R(0) is its square on the diagonal.
        nominal_dt: step in place of one that is not positive, s.
        longest_dt: longest step, s.
    """

    def __init__(
        self,
        centre: Floats,
        acceleration: float,
        measurement_noise: float,
        nominal_dt: float,
        longest_dt: float,
    ) -> None:
        self._acceleration = acceleration
        self._first_noise = measurement_noise**2
        self._process_noise = np.zeros((2, 2))
        self._nominal_dt = nominal_dt
        self._longest_dt = longest_dt
        # The first box is as good as a measurement; nothing is known of the speed but that
        # it came about within the time over which motion is followed.
        self._first_spread = np.diag([measurement_noise**2, (acceleration * longest_dt) ** 2])
        self._steady = np.zeros(2)
        self._dt = nominal_dt
        self._state: Floats = np.stack([centre, np.zeros(2)])
        self._spread: Floats = self._first_spread.copy()
        self._before = self._state

    def step(self, dt: float) -> float:
        """The time step that is used for a ``dt`` between frames, s.

        Stamps that stand still or run backwards say nothing of the real time, and over a long
        gap a velocity says nothing of the place.

        Raises:
            ValueError: ``dt`` is NaN or infinite.
        """
        if not math.isfinite(dt):
            raise ValueError(f"dt must be a finite number of seconds, not {dt}")
        return min(dt, self._longest_dt) if dt > 0 else self._nominal_dt

    def predict(self, dt: float) -> Floats:
        """Move on by ``dt`` s; returns the predicted centre (2,), px.

        The process noise is added by :meth:`correct` or :meth:`coast`, since the weights that
        scale it are known only then.
        """
        dt = self.step(dt)
        move = np.array([[1.0, dt], [0.0, 1.0]])
        by_acceleration = self._acceleration * np.array([dt**2 / 2, dt])
        self._process_noise = np.outer(by_acceleration, by_acceleration)
        self._dt = dt
        self._before = self._state
        self._state = move @ self._state
        self._spread = move @ self._spread @ move.T
        return self.centre

    def correct(self, measurement: Floats, mean_weight: float) -> None:
        """Take in the measured centre (2,), px, of this frame.

        Args:
            measurement: z, px.
            mean_weight: mean of the weights omega of this frame: Q(k+1) = mean Q(0) (eq.
                Q_update) and R(k+1) = (1 - mean) R(0) (eq. R_update).
        """
        spread = self._spread + mean_weight * self._process_noise
        gain = spread[:, 0] / (spread[0, 0] + (1 - mean_weight) * self._first_noise)
        self._state = self._state + np.outer(gain, measurement - self._state[0])
        self._spread = spread - np.outer(gain, spread[0])
        share = 1 - math.exp(-self._dt / _STEADY_TIME)
        self._steady = self._steady + share * (self._state[1] - self._steady)

    def coast(self) -> None:
        """Go without a measurement in this frame: the full process noise is added.

        The velocity of a single frame shakes with the camera. A hidden target goes on at its
        steady velocity, which fades: nobody walks on for ever behind a post.
        """
        centre = self._before[0] + self._steady * self._dt
        self._steady = self._steady * math.exp(-self._dt / _COAST_TIME)
        self._state = np.stack([centre, self._steady])
        self._spread = self._spread + self._process_noise

    def restart(self, centre: Floats) -> None:
        """Start again at ``centre`` (2,), px, with all else unknown: the target came back."""
        self._steady = np.zeros(2)
        self._state = np.stack([centre, np.zeros(2)])
        self._spread = self._first_spread.copy()

    @property
    def centre(self) -> Floats:
        """(cx, cy), px."""
        return np.array(self._state[0])

    @property
    def velocity(self) -> tuple[float, float]:
        """(vx, vy), px/s."""
        return float(self._state[1, 0]), float(self._state[1, 1])

    @property
    def covariance(self) -> Floats:
        """(4, 4) of [cx, cy, vx, vy], px^2, px^2/s, px^2/s^2."""
        return np.asarray(np.kron(self._spread, np.eye(2)), np.float64)
