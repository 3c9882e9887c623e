# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The camera: where it stands, where it looks, and where a point of the street lands in px.

The street's axes: x to the right along the houses, y up, z towards the houses; the ground is
y = 0. The camera turns about the vertical (yaw) only; pitch moves the horizon up and down as a
shift lens does, so verticals stay vertical.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NEAR = 0.6  # m: nothing nearer than this is drawn


@dataclass(frozen=True)
class CameraState:
    """Pose of the camera.

    Attributes:
        x, z: position on the ground, m.
        yaw: heading, rad; 0 looks along z (at the houses), positive to the right.
        pitch: rad, positive looks up.
        height: of the lens above the ground, m.
        yaw_rate: rad/s, what smears the image while the shutter is open.
    """

    x: float = 0.0
    z: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0
    height: float = 1.15
    yaw_rate: float = 0.0


@dataclass(frozen=True)
class Lens:
    """A pinhole without distortion: image size and focal length in px.

    The principal point is the middle column, and ``horizon`` is the row of the horizon of a
    camera whose pitch is 0, px.
    """

    width: int
    height: int
    focal: float
    horizon: float

    @classmethod
    def wide(cls, width: int, height: int) -> Lens:
        """A robot's usual camera: 62 degrees across."""
        focal = width / 2 / np.tan(np.radians(31.0))
        return cls(width, height, float(focal), height * 0.43)

    @property
    def matrix(self) -> np.ndarray:
        """Camera matrix K, (3, 3) float64."""
        return np.array(
            [[self.focal, 0, self.width / 2], [0, self.focal, self.horizon], [0, 0, 1.0]]
        )

    def horizon_row(self, camera: CameraState) -> float:
        """Row of the horizon, px."""
        return self.horizon + self.focal * float(np.tan(camera.pitch))


def to_camera(points: np.ndarray, camera: CameraState) -> np.ndarray:
    """Points (..., 3) m of the street to (right, up, forward) m seen from the camera."""
    dx, dy, dz = (
        points[..., 0] - camera.x,
        points[..., 1] - camera.height,
        points[..., 2] - camera.z,
    )
    sin, cos = np.sin(camera.yaw), np.cos(camera.yaw)
    return np.stack([cos * dx - sin * dz, dy, sin * dx + cos * dz], axis=-1)


def project(points: np.ndarray, camera: CameraState, lens: Lens) -> np.ndarray:
    """Points (..., 3) m to (column, row, depth): px, px, m; the depth must be over 0."""
    right, up, depth = np.moveaxis(to_camera(points, camera), -1, 0)
    column = lens.width / 2 + lens.focal * right / depth
    row = lens.horizon_row(camera) - lens.focal * up / depth
    return np.stack([column, row, depth], axis=-1)


def plane_to_image(
    origin: np.ndarray, along: np.ndarray, down: np.ndarray, camera: CameraState, lens: Lens
) -> np.ndarray:
    """Homography (3, 3) from a textured plane (texture px) to the image (px).

    Args:
        origin: the point of the street, m, under the texture's top-left corner.
        along: what one texel to the right is in the street, (3,) m.
        down: what one texel down is in the street, (3,) m.
        camera: from where it is seen.
        lens: through what.
    """
    corner = to_camera(np.asarray(origin, float), camera)
    still = CameraState(yaw=camera.yaw, height=0.0)
    columns = [to_camera(np.asarray(v, float), still) for v in (along, down)] + [corner]
    right, up, depth = np.stack(columns, axis=1)
    horizon = lens.horizon_row(camera)
    return np.stack(
        [
            lens.focal * right + lens.width / 2 * depth,
            -lens.focal * up + horizon * depth,
            depth,
        ]
    )
