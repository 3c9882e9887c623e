# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Somebody holds the camera: it pans after the target, a little late, and shakes."""

from __future__ import annotations

import numpy as np

from het_ros.scene.camera import CameraState
from het_ros.scene.path import STEP, Path, smooth
from het_ros.scene.stories import Story


class Operator:
    """The story's own camera, as a function of time.

    Args:
        story: says where the camera goes and whether it pans.
        target: whom it pans after.
        shake: strength, 1 is a robot on paving, 0 a tripod.
    """

    def __init__(self, rng: np.random.Generator, story: Story, target: Path, shake: float) -> None:
        self._dolly = Path(story.camera, rounding=2.0)
        self._t = np.arange(-1.0, max(story.seconds, target.end) + 1.0, STEP)
        sway = 0.05 * np.sin(2 * np.pi * self._t / rng.uniform(6, 9) + rng.uniform(0, 6))
        yaw = np.full(len(self._t), story.yaw)
        if story.follow > 0:
            bearing = np.arctan2(*(target.places(self._t) - self._dolly.places(self._t)).T)
            yaw = yaw + story.follow * smooth(bearing + sway, 1.8)
        waves = [(rng.uniform(0.7, 5.5), rng.uniform(0, 2 * np.pi)) for _ in range(12)]
        tremble = [np.sin(2 * np.pi * f * self._t + p) / f**0.8 for f, p in waves]
        self._yaw = yaw + 0.0016 * shake * np.sum(tremble[:6], axis=0)
        self._pitch = 0.0016 * shake * np.sum(tremble[6:], axis=0)
        self._rate = np.gradient(self._yaw, STEP)

    def at(self, t: float) -> CameraState:
        """The camera at a time, s."""
        x, z = self._dolly.at(t)[:2]
        yaw, pitch, rate = (
            float(np.interp(t, self._t, track)) for track in (self._yaw, self._pitch, self._rate)
        )
        return CameraState(x=x, z=z, yaw=yaw, pitch=pitch, yaw_rate=rate)
