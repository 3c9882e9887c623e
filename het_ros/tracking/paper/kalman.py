# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Top layer: the adaptive Kalman filter over the target's centre."""

from __future__ import annotations

import math

import numpy as np

# Its package loads SciPy's statistics and matplotlib whichever part is asked for (0.7 s, 70 MB):
# nothing outside this package imports this module before the paper's tracker is chosen.
from filterpy.common import Q_discrete_white_noise
from filterpy.kalman import KalmanFilter
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class AdaptiveKalman:
    """Constant-velocity filter over x = [cx, cy, vx, vy], px and px/s, eq. (14) "Kalman(k+1)".

    The measurement is the target's centre, so B is 2 x 4 (the paper prints the 2 x 2 identity).
    A frame is :meth:`predict`, :meth:`adapt` and :meth:`correct`, in this order.

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
        self._first_process_noise = np.zeros((4, 4))
        self._first_measurement_noise = measurement_noise**2 * np.eye(2)
        self._nominal_dt = nominal_dt
        self._longest_dt = longest_dt
        self._filter = KalmanFilter(dim_x=4, dim_z=2)
        self._filter.x = np.array([*centre, 0.0, 0.0])
        self._filter.H = np.eye(2, 4)
        # The first box is as good as a measurement; nothing is known of the speed but that
        # it came about within the time over which motion is followed.
        speed = acceleration * longest_dt
        self._filter.P = np.diag([measurement_noise**2] * 2 + [speed**2] * 2)

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
        """Move on by ``dt`` s, x(k+1|k) = A x(k|k); returns the predicted centre (2,), px.

        The process noise is added by :meth:`adapt`, since the weights that scale it are known
        only then.
        """
        dt = self.step(dt)
        self._filter.F = np.array(
            [[1, 0, dt, 0], [0, 1, 0, dt], [0, 0, 1, 0], [0, 0, 0, 1]], dtype=np.float64
        )
        self._first_process_noise = Q_discrete_white_noise(
            dim=2, dt=dt, var=self._acceleration**2, block_size=2, order_by_dim=False
        )
        self._filter.predict(Q=np.zeros((4, 4)))
        return self.centre

    def adapt(self, mean_weight: float) -> None:
        """Fit this frame's noises to how the sub-patches compare.

        Q(k+1) = mean Q(0), eq. (15) "Q_update"; R(k+1) = (1 - mean) R(0), eq. (16) "R_update".

        Args:
            mean_weight: mean of the weights omega of this frame.
        """
        self._filter.P = self._filter.P + mean_weight * self._first_process_noise
        self._filter.R = (1 - mean_weight) * self._first_measurement_noise

    def correct(self, measurement: Floats) -> None:
        """Take in z(k+1), the measured centre (2,), px, of this frame."""
        self._filter.update(measurement)

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
