# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The target's exact motion in the image: its own, and what the camera's motion adds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from het_ros.scene.camera import NEAR, CameraState, project
from het_ros.scene.scene import Scene

MIDDLE = 0.88  # m: height of the point that stands for the target, half that of a figure
STEP = 0.01  # s: of the central difference; the camera's path has a sample in each


@dataclass(frozen=True)
class ImageMotion:
    """Velocity of the target's centre in the image; the sum of both is the whole.

    Attributes:
        own: what a camera that stands still would see, px/s.
        camera: what a target that stands still would do in the moving image, px/s.
    """

    own: tuple[float, float]
    camera: tuple[float, float]


def image_motion(scene: Scene, t: float) -> ImageMotion | None:
    """At a time, s, seen by the story's own camera; None where the target is not before it.

    The partial derivatives of the projection of a point in the target's middle, by the target's
    place and by the camera's pose. Its limbs do not count, as of a box that does not breathe.
    """
    before, now, after = t - STEP, t, t + STEP
    here = scene.camera_at(now)
    own = [_seen(scene, moment, here) for moment in (before, after)]
    camera = [_seen(scene, now, scene.camera_at(moment)) for moment in (before, after)]
    if min(place[2] for place in (*own, *camera)) < NEAR:
        return None
    first, second = ((late - early)[:2] / (2 * STEP) for early, late in (own, camera))
    return ImageMotion((float(first[0]), float(first[1])), (float(second[0]), float(second[1])))


def _seen(scene: Scene, t: float, camera: CameraState) -> np.ndarray:
    """Column, row and depth of the target's middle at ``t`` s, seen by some camera."""
    x, z = scene.target_at(t)
    return project(np.array([x, MIDDLE, z]), camera, scene.lens)
