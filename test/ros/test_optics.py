# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest
from sensor_msgs.msg import CameraInfo, RegionOfInterest

from het_ros.ros.optics import CameraError, bearing_message, ray_of

from .streams import header_at

MATRIX = [500.0, 0.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0]
SIZE = (640, 480)
PLUMB = [-0.30, 0.10, 0.001, -0.002, 0.01]
RATIONAL = [0.5, -0.2, 0.001, 0.0005, 0.02, 0.8, -0.1, 0.03]
EQUIDISTANT = [0.02, -0.01, 0.003, -0.001]


def camera(model="plumb_bob", distortion=(), **more) -> CameraInfo:
    projection = [400.0, 0.0, 300.0, 0.0, 0.0, 410.0, 250.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    return CameraInfo(
        width=640, height=480, k=MATRIX, p=projection, d=list(distortion),
        distortion_model=model, **more,
    )  # fmt: skip


def seen_at(ray, info) -> tuple[float, float]:
    """Where a camera sees a ray, in px from the corner: OpenCV's own forward model."""
    point = np.array([[[ray[0] / ray[2], ray[1] / ray[2], 1.0]]])
    matrix, zero = np.array(info.k).reshape(3, 3), np.zeros(3)
    if info.distortion_model == "equidistant":
        pixel = cv2.fisheye.projectPoints(point, zero, zero, matrix, np.array(info.d))[0]
    else:
        pixel = cv2.projectPoints(point, zero, zero, matrix, np.array(info.d))[0]
    return tuple(pixel.ravel() + 0.5)


@pytest.mark.parametrize(
    "model, distortion",
    [
        ("plumb_bob", []),
        ("plumb_bob", [0.0] * 5),
        ("", []),
        ("plumb_bob", PLUMB),
        ("rational_polynomial", RATIONAL),
        ("equidistant", EQUIDISTANT),
    ],
)
@pytest.mark.parametrize("slope", [(0, 0), (0.3, -0.2), (-0.45, 0.3), (0.5, 0.35)])
def test_a_ray_is_where_its_pixel_was_seen(model, distortion, slope):
    info = camera(model, distortion)
    wanted = np.array([*slope, 1.0]) / np.linalg.norm([*slope, 1.0])
    np.testing.assert_allclose(ray_of(seen_at(wanted, info), info, SIZE), wanted, atol=1e-5)


def test_the_optical_axis_is_half_a_pixel_off_the_calibrated_centre():
    np.testing.assert_allclose(ray_of((320.5, 240.5), camera(), SIZE), [0, 0, 1], atol=1e-12)


def test_right_and_down_are_positive():
    x, y, z = ray_of((600, 400), camera(), SIZE)
    assert x > 0 and y > 0 and z > 0


def test_binning_and_region_are_undone():
    whole = ray_of((404, 308), camera(), SIZE)
    region = RegionOfInterest(x_offset=100, y_offset=60, width=440, height=360)
    part = camera(binning_x=2, binning_y=2, roi=region)
    np.testing.assert_allclose(ray_of((152, 124), part, (220, 180)), whole, atol=1e-12)


def test_rectified_images_use_p_and_no_distortion():
    ray = ray_of((300.5 + 40, 250.5 + 41), camera(distortion=PLUMB), SIZE, rectified=True)
    np.testing.assert_allclose(ray / ray[2], [0.1, 0.1, 1.0])


@pytest.mark.parametrize(
    "change, says",
    [
        ({"k": [0.0] * 9}, "no calibration"),
        ({"k": [1.0] * 9}, "no camera matrix"),  # singular
        ({"d": [0.1] * 6}, "6 numbers"),
        ({"d": [0.1], "distortion_model": "equidistant"}, "1 numbers"),
        ({"d": [], "k": [1e-300, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]}, "no inverse"),
        ({"distortion_model": "my_own", "d": [0.1]}, "my_own"),
        ({"width": 1280, "height": 960}, "1280 x 960"),
    ],
)
def test_cameras_that_give_no_rays(change, says):
    info = camera(distortion=PLUMB)
    for name, value in change.items():
        setattr(info, name, value)
    with pytest.raises(CameraError, match=says):
        ray_of((100, 100), info, SIZE)


def test_message():
    message = bearing_message(np.array([0.6, 0.0, 0.8]), header_at(2.0, "optical"))
    assert message.header == header_at(2.0, "optical")
    assert (message.vector.x, message.vector.y, message.vector.z) == (0.6, 0.0, 0.8)
