# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Top layer: the target's velocity, filtered for who drives by it.

The box's filter follows fast and its velocity shakes. This one takes the same measured centres
and knows two velocities that add up: a steady one, which hardly changes, and a brief one (steps,
turns, a shaking camera), which fades within a tenth of a second. So an even motion is not
underestimated, and a jerk is not taken for a new course. Process noise and measurement noise
follow the innovations, and so does the covariance that is told. A causal filter can be smoother
only by lagging.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.motion import Motion, way_of

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class VelocityConfig:
    """Constants, lengths in target sides; fitted to 37 real sequences together.

    Attributes:
        centre: deviation of a measured centre.
        steady_change: white acceleration of the steady velocity, sides/s^1.5.
        brief_change: the same of the brief velocity.
        steady_time, brief_time: s, in which they fall to 1/e.
        first_speed: deviation of the steady velocity before anything is known, sides/s.
        rate: weight of a new innovation in their mean (about 20 frames).
        least, most: limits of that mean, of what the filter expects (1 is as expected).
        scatter: covariance over the filter's own and over that mean: 95 % of the errors are inside
            its 95 % bound, whether the innovations are small or large.
        coast_time: s, in which a velocity falls to 1/e while it is predicted, hidden or ahead.
        coast_change: white acceleration of a target that is not seen, sides/s^1.5.
    """

    centre: float = 0.075
    steady_change: float = 1.2
    brief_change: float = 6.5
    steady_time: float = 4.0
    brief_time: float = 0.073
    first_speed: float = 2.0
    rate: float = 0.05
    least: float = 0.1
    most: float = 8.0
    scatter: float = 1.6
    coast_time: float = 0.5
    coast_change: float = 2.5


class VelocityFilter:
    """Kalman filter over [centre, steady, brief]; x and y share covariance and gain.

    Args:
        centre: (D,) of the first frame, px: (x, y).
        side: of the target, px.
        config: constants; by default those fitted to boxes in images.
    """

    def __init__(self, centre: Floats, side: float, config: VelocityConfig | None = None) -> None:
        self._config = config or VelocityConfig()
        self.restart(centre, side)

    def restart(self, centre: Floats, side: float) -> None:
        """Start again at ``centre`` (D,), px, with all else unknown: the target came back."""
        config = self._config
        self._side, self._strange, self._seen = side, 1.0, True
        self._state = np.stack([centre, 0.0 * centre, 0.0 * centre])
        brief = config.brief_change**2 * config.brief_time / 2
        self._spread = side**2 * np.diag([config.centre**2, config.first_speed**2, brief])

    def predict(self, dt: float, side: float) -> None:
        """Move on by ``dt`` s, positive; ``side`` is the target's, px."""
        config, self._side = self._config, side
        steady, brief = math.exp(-dt / config.steady_time), math.exp(-dt / config.brief_time)
        ways = way_of(config.steady_time, dt), way_of(config.brief_time, dt)
        move = np.array([[1.0, *ways], [0.0, steady, 0.0], [0.0, 0.0, brief]])
        unrest = side**2 * self._surprise
        slow = unrest * config.steady_change**2
        # A brief velocity keeps its deviation, whatever the step: what fades is renewed.
        renewed = config.brief_time / 2 * (1 - brief**2) / dt
        quick = unrest * config.brief_change**2 * renewed
        if not self._seen:
            slow += (side * config.coast_change) ** 2
        noise = np.array(
            [
                [(slow + quick) * dt**3 / 3, slow * dt**2 / 2, quick * dt**2 / 2],
                [slow * dt**2 / 2, slow * dt, 0.0],
                [quick * dt**2 / 2, 0.0, quick * dt],
            ]
        )
        self._state = move @ self._state
        self._spread = move @ self._spread @ move.T + noise
        self._dt = dt

    def correct(self, centre: Floats) -> None:
        """Take in the measured centre (D,), px, of this frame."""
        config, self._seen = self._config, True
        noise = (config.centre * self._side) ** 2 * min(max(self._strange, 1.0), config.most)
        expected = self._spread[0, 0] + noise
        innovation = centre - self._state[0]
        gain = self._spread[:, 0] / expected
        self._state = self._state + np.outer(gain, innovation)
        self._spread = self._spread - np.outer(gain, self._spread[0])
        # One leap says little of the frames to come.
        surprise = min(float(innovation @ innovation) / (len(centre) * expected), 15.0)
        self._strange += config.rate * (surprise - self._strange)

    def coast(self) -> None:
        """Go without a measurement in this frame: the steady velocity fades."""
        self._seen = False
        self._state[1] *= math.exp(-self._dt / self._config.coast_time)

    @property
    def _surprise(self) -> float:
        """Mean square of the innovations over what the filter expects, within its limits."""
        return min(max(self._strange, self._config.least), self._config.most)

    @property
    def motion(self) -> Motion:
        """What is known now."""
        config, spread, dimensions = self._config, self._spread, self._state.shape[1]
        change = config.steady_change + (0.0 if self._seen else config.coast_change)
        return Motion(
            self._state[1].copy(),
            self._state[2].copy(),
            config.scatter * self._surprise * float(spread[1:, 1:].sum()) * np.eye(dimensions),
            config.coast_time,  # what is not measured any more fades as a hidden target's
            config.brief_time,
            self._side * change,
        )

    @property
    def centre(self) -> Floats:
        """(D,), px: the filtered centre."""
        return np.array(self._state[0])

    @property
    def centre_variance(self) -> float:
        """Of each of its coordinates, px^2."""
        return float(self._spread[0, 0])
