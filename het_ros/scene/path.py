# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Smooth movement through waypoints."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

STEP = 0.01  # s


def smooth(samples: np.ndarray, seconds: float) -> np.ndarray:
    """Samples (n, ...) at STEP, averaged under a Hann window of that length."""
    size = max(int(seconds / STEP) | 1, 3)
    window = np.hanning(size + 2)[1:-1]
    window /= window.sum()
    pad = size // 2
    padded = np.concatenate(
        [np.repeat(samples[:1], pad, 0), samples, np.repeat(samples[-1:], pad, 0)]
    )
    flat = padded.reshape(len(padded), -1)
    columns = [np.convolve(column, window, mode="valid") for column in flat.T]
    return np.stack(columns, axis=1).reshape(samples.shape)


class Path:
    """Waypoints (t s, x m, z m) walked through with rounded corners; before and after, it stands.

    Raises:
        ValueError: fewer than one waypoint, or times that do not grow.
    """

    def __init__(
        self, waypoints: Sequence[tuple[float, float, float]], rounding: float = 0.8
    ) -> None:
        points = np.asarray(waypoints, float)
        if points.ndim != 2 or len(points) == 0 or (np.diff(points[:, 0]) <= 0).any():
            raise ValueError(f"waypoints are (t, x, z) with growing times, not {waypoints}")
        self._t = np.arange(points[0, 0] - 1.0, points[-1, 0] + 1.0, STEP)
        place = np.stack([np.interp(self._t, points[:, 0], points[:, k]) for k in (1, 2)], axis=1)
        self._place = smooth(place, rounding)
        velocity = np.gradient(self._place, STEP, axis=0)
        self._speed = np.hypot(*velocity.T)
        self._walked = np.cumsum(self._speed) * STEP
        self._heading = smooth(self._headings(velocity), 0.5)

    def _headings(self, velocity: np.ndarray) -> np.ndarray:
        """Headings, rad, unwrapped; held where it stands."""
        moving = np.flatnonzero(self._speed > 0.08)
        if len(moving) == 0:
            return np.full(len(velocity), np.pi / 2)
        angles = np.unwrap(np.arctan2(velocity[moving, 0], velocity[moving, 1]))
        latest = np.clip(np.searchsorted(moving, np.arange(len(velocity)), "right") - 1, 0, None)
        return angles[latest]

    def at(self, t: float) -> tuple[float, float, float, float, float]:
        """(x m, z m, heading rad, distance walked m, speed m/s) at a time, s."""
        tracks = (*self._place.T, self._heading, self._walked, self._speed)
        x, z, heading, walked, speed = (float(np.interp(t, self._t, k)) for k in tracks)
        return x, z, heading, walked, speed if self._t[0] < t < self._t[-1] else 0.0

    def places(self, times: np.ndarray) -> np.ndarray:
        """(x, z) m at many times (n,) s, (n, 2)."""
        return np.stack([np.interp(times, self._t, k) for k in self._place.T], axis=1)

    @property
    def end(self) -> float:
        """Time of the last waypoint, s."""
        return float(self._t[-1] + STEP - 1.0)
