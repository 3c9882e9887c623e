# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Top layer: the adaptive Kalman filter over the target's centre."""

from __future__ import annotations

import math

import numpy as np
from filterpy.common import Q_discrete_white_noise
from filterpy.kalman import KalmanFilter
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_STEADY_TIME = 0.4  # s, over which velocities are averaged for coasting
_COAST_TIME = 0.5  # s, in which a hidden target's velocity falls to 1/e


class AdaptiveKalman:
    """Constant-velocity filter over x = [cx, cy, vx, vy], px and px/s (eq. Kalman(k+1)).

    The measurement is the target's centre, so B is 2 x 4 (the paper prints the 2 x 2 identity).
    The noises follow the mean weight of the sub-patches (eqs. Q_update, R_update).

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
        self._first_noise = measurement_noise**2 * np.eye(2)
        self._process_noise = np.zeros((4, 4))
        self._nominal_dt = nominal_dt
        self._longest_dt = longest_dt
        self._filter = KalmanFilter(dim_x=4, dim_z=2)
        self._filter.x = np.array([*centre, 0.0, 0.0])
        self._filter.H = np.eye(2, 4)
        # The first box is as good as a measurement; nothing is known of the speed but that
        # it came about within the time over which motion is followed.
        speed = acceleration * longest_dt
        self._first_covariance = np.diag([measurement_noise**2] * 2 + [speed**2] * 2)
        self._filter.P = self._first_covariance.copy()
        self._steady = np.zeros(2)
        self._before = self._filter.x
        self._dt = nominal_dt

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
        self._filter.F = np.array(
            [[1, 0, dt, 0], [0, 1, 0, dt], [0, 0, 1, 0], [0, 0, 0, 1]], dtype=np.float64
        )
        self._process_noise = Q_discrete_white_noise(
            dim=2, dt=dt, var=self._acceleration**2, block_size=2, order_by_dim=False
        )
        self._dt = dt
        self._before = self._filter.x.copy()
        self._filter.predict(Q=np.zeros((4, 4)))
        return self.centre

    def shift(self, way: Floats) -> None:
        """Move the prediction of this frame by ``way`` (2,), px: the camera moved its ground."""
        self._filter.x[:2] = self._filter.x[:2] + way
        self._before[:2] = self._before[:2] + way

    def change_velocity(self, by: Floats) -> None:
        """Count the velocity from another frame of reference from now on: ``by`` (2,), px/s."""
        self._filter.x[2:] = self._filter.x[2:] + by
        self._steady = self._steady + by

    def correct(self, measurement: Floats, mean_weight: float) -> None:
        """Take in the measured centre (2,), px, of this frame.

        Args:
            measurement: z, px.
            mean_weight: mean of the weights omega of this frame: Q(k+1) = mean Q(0) (eq.
                Q_update) and R(k+1) = (1 - mean) R(0) (eq. R_update).
        """
        self._filter.P = self._filter.P + mean_weight * self._process_noise
        self._filter.update(measurement, R=(1 - mean_weight) * self._first_noise)
        share = 1 - math.exp(-self._dt / _STEADY_TIME)
        self._steady = self._steady + share * (self._filter.x[2:] - self._steady)

    def coast(self) -> None:
        """Go without a measurement in this frame: the full process noise is added.

        The velocity of a single frame shakes with the camera. A hidden target goes on at its
        steady velocity, which fades: nobody walks on for ever behind a post.
        """
        self._filter.x[:2] = self._before[:2] + self._steady * self._dt
        self._steady = self._steady * math.exp(-self._dt / _COAST_TIME)
        self._filter.x[2:] = self._steady
        self._filter.P = self._filter.P + self._process_noise

    def restart(self, centre: Floats) -> None:
        """Start again at ``centre`` (2,), px, with all else unknown: the target came back."""
        self._steady = np.zeros(2)
        self._filter.x = np.array([*centre, 0.0, 0.0])
        self._filter.P = self._first_covariance.copy()

    @property
    def centre(self) -> Floats:
        """(cx, cy), px."""
        return np.array(self._filter.x[:2])

    @property
    def velocity(self) -> tuple[float, float]:
        """(vx, vy), px/s."""
        return float(self._filter.x[2]), float(self._filter.x[3])

    @property
    def covariance(self) -> Floats:
        """(4, 4) of [cx, cy, vx, vy], px^2, px^2/s, px^2/s^2."""
        return np.array(self._filter.P)
