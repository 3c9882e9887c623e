# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a target is that is not seen: by the robot's own motion and the target's last velocity."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

MEMORY = 1.0  # s of places that the velocity is taken from while nothing is seen
RECENT = 0.5  # s of places that its place is taken from while it is: a turn is seen so late
SHORTEST = 0.3  # s: over less a velocity is noise


class Reckoning:
    """Places of the target, kept where the robot stood at the start: x to the right, z forward, m.

    The robot's motion is what it was told to do, in want of odometry. All times are s of one
    monotonic clock.
    """

    def __init__(self) -> None:
        self._pose = (0.0, 0.0, 0.0)  # x m, z m, yaw rad, positive to the right
        self._twist = (0.0, 0.0)
        self._time = -math.inf
        self._places: deque[tuple[float, float, float]] = deque()

    def told(self, linear: float, angular: float, now: float) -> None:
        """Take the command (m/s forward, rad/s to the left) that holds from now on."""
        self._move(now)
        self._twist = linear, angular

    def seen(self, x: float, z: float, now: float) -> None:
        """Take a place of the target, m to the right of the robot and before it."""
        self._move(now)
        right, forward, yaw = self._pose
        cos, sin = math.cos(yaw), math.sin(yaw)
        if self._places and now - self._places[-1][0] > MEMORY:
            self._places.clear()
        self._places.append((now, right + cos * x + sin * z, forward - sin * x + cos * z))
        while now - self._places[0][0] > MEMORY:
            self._places.popleft()

    def predicted(self, now: float) -> tuple[float, float]:
        """(x, z) m to the right and forward where the target should be now; (0, 0) before any."""
        self._move(now)
        if not self._places:
            return 0.0, 0.0
        times, *places = np.array(self._places).T
        x, z = (_carried_on(now, times, track) for track in places)
        right, forward, yaw = self._pose
        cos, sin = math.cos(yaw), math.sin(yaw)
        x, z = x - right, z - forward
        return cos * x - sin * z, sin * x + cos * z

    def _move(self, now: float) -> None:
        """Move on by the command that held until now."""
        passed, self._time = now - self._time, now
        if not 0 < passed < MEMORY:
            return
        x, z, yaw = self._pose
        linear, angular = self._twist
        yaw -= angular * passed
        self._pose = (
            x + linear * math.sin(yaw) * passed, z + linear * math.cos(yaw) * passed, yaw
        )  # fmt: skip


def _carried_on(now: float, times: np.ndarray, track: np.ndarray) -> float:
    """A coordinate (n,) m of ``times`` (n,) s, at ``now`` on the line through the latest of them.

    A line through places shakes less than the last of them, and is not late behind an even
    motion, as their mean is.
    """
    last = float(times[-1])
    if last - times[0] < SHORTEST:
        return float(track[-1])
    recent = times >= last - RECENT
    place = np.polyfit(times[recent] - last, track[recent], 1)[1]
    speed = np.polyfit(times - last, track, 1)[0]
    return float(place + speed * (now - last))
