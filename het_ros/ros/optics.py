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
    # A calibration counts from the centre of the top-left pixel, a box from its corner.
    x, y = _on_sensor(point, info, size)
    pixel = np.array([[[x - 0.5, y - 0.5]]])
    distortion = np.array([] if rectified else info.d, float)
    if not distortion.any():
        inverse = np.linalg.inv(matrix)
        slope = (inverse @ [x - 0.5, y - 0.5, 1.0])[:2]
    elif info.distortion_model in FISHEYE:
        slope = cv2.fisheye.undistortPoints(pixel, matrix, distortion[:4])[0, 0]
    elif info.distortion_model in PINHOLE:
        slope = _undistort(pixel, matrix, distortion)[0, 0]
    else:
        known = ", ".join(name for name in (*PINHOLE, *FISHEYE) if name)
        raise CameraError(f"the distortion model {info.distortion_model!r} is none of {known}")
    ray = np.array([slope[0], slope[1], 1.0])
    if not np.isfinite(ray).all():
        raise CameraError("the distortion has no inverse at this point: check the calibration")
    return ray / np.linalg.norm(ray)


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
