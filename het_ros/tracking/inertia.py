# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether the target keeps its way in the scene or in the image.

A shaking camera moves the target and all that stands around it alike: in the scene the target goes
on as before. A camera that is turned to keep the target in its middle moves everything but the
target: in the image it goes on as before. Both are predicted in every frame, and the motion model
lives in the frame of reference that was right more often.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.camera import CameraMotion, Image

Floats = NDArray[np.float64]

_ERROR_RATE = 0.2  # of the running mean errors of both predictions, a frame
_VELOCITY_RATE = 0.5  # of the velocities they are made with, a frame
_BETTER = 0.8  # of the image's error: the scene must be this much better to be gone over to
_ALIKE = 0.005  # target sides: errors that differ by less are the same


class Inertia:
    """Keeps both predictions and says what the motion model is to be moved by.

    Args:
        image: the first one, (H, W, 3) or (H, W) uint8.
        centre: of the target in it, (x, y) px.

    Attributes:
        camera_shift: (x, y), px: how far the last image's scene moved, whatever is done with it.
    """

    def __init__(self, image: Image, centre: Floats) -> None:
        self._camera = CameraMotion(image)
        self._in_scene = False
        self.camera_shift = np.zeros(2)
        self._before: Floats | None = np.array(centre)
        # Velocities, px/s, and errors, target sides, of the predictions in image and scene.
        self._velocities: Floats | None = None  # (2, 2)
        self._errors = np.zeros(2)

    @property
    def carried(self) -> Floats:
        """(x, y), px/s: velocity in the image of the motion model's frame of reference."""
        return self._camera.velocity if self._in_scene else np.zeros(2)

    def shift(self, image: Image, dt: float) -> Floats:
        """(x, y), px: what the camera moved the motion model's frame of reference by.

        Args:
            image: the next one.
            dt: time since the last one, s, positive.
        """
        self.camera_shift = self._camera.follow(image, dt)
        return self.camera_shift if self._in_scene else np.zeros(2)

    def observe(self, centre: Floats, side: float, dt: float) -> Floats:
        """Learn from where the target was seen in the image of the last :meth:`shift`.

        Args:
            centre: (x, y), px.
            side: of the target, px.
            dt: time since the last image, s.

        Returns:
            (x, y), px/s: what the motion model's velocity changes by because it lives in another
            frame of reference from now on; else 0.
        """
        before, self._before = self._before, np.array(centre)
        if before is None:
            return np.zeros(2)
        ways = np.array([centre - before, centre - before - self.camera_shift])
        if self._velocities is None:
            self._velocities = ways / dt
            return np.zeros(2)
        missed = np.hypot(*(ways - self._velocities * dt).T) / side
        self._errors += _ERROR_RATE * (missed - self._errors)
        self._velocities = self._velocities + _VELOCITY_RATE * (ways / dt - self._velocities)
        in_image, in_scene = self._errors
        least = in_image if self._in_scene else _BETTER * in_image
        change = bool(in_scene + _ALIKE < least) is not self._in_scene
        if not change:
            return np.zeros(2)
        self._in_scene = not self._in_scene
        return -self._camera.velocity if self._in_scene else self._camera.velocity

    def forget(self) -> None:
        """The target is hidden: its next place says nothing of its way from the last."""
        self._before = None
