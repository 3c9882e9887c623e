# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a pixel to a ray: the camera model of a CameraInfo."""

from __future__ import annotations

import cv2
import numpy as np
from geometry_msgs.msg import Vector3, Vector3Stamped
from numpy.typing import NDArray
from sensor_msgs.msg import CameraInfo
from std_msgs.msg import Header

FISHEYE = ("equidistant", "fisheye")
PINHOLE = ("plumb_bob", "rational_polynomial", "")


class CameraError(ValueError):
    """A CameraInfo that gives no rays; the text says why."""


def ray_of(
    point: tuple[float, float], info: CameraInfo, size: tuple[int, int], rectified: bool = False
) -> NDArray[np.float64]:
    """The ray through a point, ``(3,) float64`` of length 1 in the optical frame (z forward).

    Args:
        point: (x, y) px; (0, 0) is the top-left corner of the top-left pixel.
        info: the camera's calibration, of the whole sensor or of a part (binning, roi).
        size: (width, height) of the image that the point is in, px.
        rectified: the image is rectified: P holds for it, and no distortion.

    Raises:
        CameraError: no calibration, an unknown distortion model or a calibration of another size.
    """
    matrix = np.array(info.p, float).reshape(3, 4)[:, :3] if rectified else None
    matrix = np.array(info.k, float).reshape(3, 3) if matrix is None else matrix
    if not (np.isfinite(matrix).all() and matrix[0, 0] > 0 and matrix[1, 1] > 0):
        raise CameraError("camera_info has no calibration (fx, fy are 0): calibrate the camera")
    if matrix[1, 0] != 0 or (matrix[2] != (0, 0, 1)).any():
        raise CameraError("camera_info has no camera matrix [fx s cx; 0 fy cy; 0 0 1]: calibrate")
    # A calibration counts from the centre of the top-left pixel, a box from its corner.
    x, y = _on_sensor(point, info, size)
    pixel = np.array([[[x - 0.5, y - 0.5]]])
    distortion = np.array([] if rectified else info.d, float)
    slope = _slope(pixel, matrix, distortion, info.distortion_model)
    ray = np.array([slope[0], slope[1], 1.0])
    if not np.isfinite(length := np.linalg.norm(ray)):
        raise CameraError("the distortion has no inverse at this point: check the calibration")
    return ray / length


def _slope(
    pixel: NDArray[np.float64],
    matrix: NDArray[np.float64],
    distortion: NDArray[np.float64],
    model: str,
) -> NDArray[np.float64]:
    """(x / z, y / z) of the ray through a pixel (1, 1, 2); may be NaN or infinite."""
    if not distortion.any():
        return (np.linalg.inv(matrix) @ [*pixel[0, 0], 1.0])[:2]
    try:
        if model in FISHEYE:
            return cv2.fisheye.undistortPoints(pixel, matrix, distortion[:4])[0, 0]
        if model in PINHOLE:
            return _undistort(pixel, matrix, distortion)[0, 0]
    except cv2.error as error:
        raise CameraError(
            f"{distortion.size} numbers are no distortion of the model {model!r}: calibrate"
        ) from error
    known = ", ".join(name for name in (*PINHOLE, *FISHEYE) if name)
    raise CameraError(f"the distortion model {model!r} is none of {known}")


def bearing_message(ray: NDArray[np.float64], header: Header) -> Vector3Stamped:
    """A ray as a message."""
    x, y, z = map(float, ray)
    return Vector3Stamped(header=header, vector=Vector3(x=x, y=y, z=z))


def _undistort(
    pixel: NDArray[np.float64], matrix: NDArray[np.float64], distortion: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Invert the polynomial model to the end; OpenCV's own five rounds leave wide lenses off."""
    enough = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-9)
    if hasattr(cv2, "undistortPointsIter"):  # OpenCV 4
        return cv2.undistortPointsIter(pixel, matrix, distortion, None, None, enough)
    return cv2.undistortPoints(pixel, matrix, distortion, criteria=enough)


def _on_sensor(
    point: tuple[float, float], info: CameraInfo, size: tuple[int, int]
) -> tuple[float, float]:
    """The point on the sensor that was calibrated, px, undoing region and binning."""
    binning = max(info.binning_x, 1), max(info.binning_y, 1)
    whole = info.roi.width == 0 or info.roi.height == 0
    region = (info.width, info.height) if whole else (info.roi.width, info.roi.height)
    offset = (0, 0) if whole else (info.roi.x_offset, info.roi.y_offset)
    expected = region[0] // binning[0], region[1] // binning[1]
    if expected != size:
        raise CameraError(
            f"camera_info is for {expected[0]} x {expected[1]} px, the image has "
            f"{size[0]} x {size[1]} px: send the calibration of this image"
        )
    return point[0] * binning[0] + offset[0], point[1] * binning[1] + offset[1]
