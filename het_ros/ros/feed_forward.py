# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a follower's command owes to the target's own motion, beside distance and bearing."""

from __future__ import annotations

import math

_SMOOTH = 0.6  # s, over which the ground velocity is averaged: commands must not feed themselves
_LATE = 0.15  # s, by which a measured velocity is late


class FeedForward:
    """The target's velocity over the ground, kept in the robot's axes: right and forward, m/s.

    What is measured is relative to a camera that drives and turns with the robot. The robot's
    motion is what it was told to do, in want of odometry.

    Args:
        lasts: s, for which a velocity is good.
    """

    def __init__(self, lasts: float) -> None:
        self._lasts = lasts
        self._ground = (0.0, 0.0)
        self._heard = -math.inf
        self._twist = (0.0, 0.0)
        self._felt = (0.0, 0.0)
        self._place = (0.0, 0.0)

    def told(self, linear: float, angular: float) -> None:
        """Take the command that holds from now on, m/s forward and rad/s to the left."""
        self._twist = linear, angular

    def on_place(self, x: float, z: float) -> None:
        """Take where the target is, m to the right and forward."""
        self._place = x, z

    def on_velocity(self, x: float, z: float, now: float) -> None:
        """Take the target's velocity relative to the camera, m/s to the right and forward."""
        if not (math.isfinite(x) and math.isfinite(z)):
            return
        passed, self._heard = now - self._heard, now
        fresh = passed > self._lasts
        # The measured velocity is late: so is the robot's own that is taken out of it.
        self._felt = _nearer(self._felt, self._twist, 1.0 if fresh else passed / _LATE)
        linear, angular = self._felt
        # A turn to the left carries what stands still to the right and, at the right, nearer.
        right = x - angular * self._place[1]
        forward = z + angular * self._place[0] + linear
        goal = right, forward
        self._ground = _nearer(self._ground, goal, 0.0 if fresh else passed / _SMOOTH)

    def known(self, now: float) -> bool:
        """Whether there is a fresh velocity."""
        return now - self._heard <= self._lasts

    def rates(self, x: float, z: float, now: float) -> tuple[float, float]:
        """How the target at (x, z) m moves by itself.

        Returns:
            m/s away from the robot and rad/s to the left around it (with what the robot's own
            drive adds, without its turn); (0, 0) where nothing fresh is known.
        """
        away = math.hypot(x, z)
        if not self.known(now) or away < 0.1:
            return 0.0, 0.0
        right, forward = self._ground
        outwards = (right * x + forward * z) / away
        return outwards, -(z * right - x * (forward - self._twist[0])) / away**2


def _nearer(
    value: tuple[float, float], goal: tuple[float, float], share: float
) -> tuple[float, float]:
    """A part of the way from a value to its goal."""
    part = min(share, 1.0)
    return value[0] + part * (goal[0] - value[0]), value[1] + part * (goal[1] - value[1])
