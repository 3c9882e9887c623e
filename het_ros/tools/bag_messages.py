# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages for bags, made without rclpy: images and boxes with their stamps."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.tools.bag_writer import TYPESTORE
from het_ros.tracking.box import Box

IMAGE_TOPIC = "/image"
COMPRESSED_TOPIC = "/image/compressed"
INIT_BOX_TOPIC = "/tracker/init_box"
TRUTH_BOX_TOPIC = "/ground_truth/box"
VISIBILITY_TOPIC = "/ground_truth/visibility"  # DiagnosticArray with the value "visible", 0..1

IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
POLYGON = "geometry_msgs/msg/PolygonStamped"
DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"

_TYPES = TYPESTORE.types


def header(stamp: int, frame_id: str) -> Any:
    """std_msgs/Header of a stamp in ns."""
    seconds, nanoseconds = divmod(stamp, 10**9)
    time = _TYPES["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)
    return _TYPES["std_msgs/msg/Header"](stamp=time, frame_id=frame_id)


def stamp_of(message: Any) -> int:
    """Header stamp of any stamped message, ns."""
    return int(message.header.stamp.sec) * 10**9 + int(message.header.stamp.nanosec)


def image_message(image: NDArray[np.uint8], stamp: int, frame_id: str) -> Any:
    """sensor_msgs/Image of a (H, W, 3) BGR or (H, W) gray uint8 image."""
    image = np.ascontiguousarray(image)
    return _TYPES[IMAGE](
        header=header(stamp, frame_id),
        height=image.shape[0],
        width=image.shape[1],
        encoding="mono8" if image.ndim == 2 else "bgr8",
        is_bigendian=0,
        step=image.strides[0],
        data=image.reshape(-1),
    )


def compressed_image_message(data: bytes, stamp: int, frame_id: str, kind: str = "jpeg") -> Any:
    """sensor_msgs/CompressedImage of the bytes of a JPEG or PNG file."""
    return _TYPES[COMPRESSED_IMAGE](
        header=header(stamp, frame_id), format=kind, data=np.frombuffer(data, np.uint8)
    )


def box_message(box: Box, stamp: int, frame_id: str) -> Any:
    """geometry_msgs/PolygonStamped: the four corners of a box, px, clockwise from the top left."""
    left, top, right, bottom = box.x, box.y, box.x + box.w, box.y + box.h
    corners = ((left, top), (right, top), (right, bottom), (left, bottom))
    point = _TYPES["geometry_msgs/msg/Point32"]
    points = [point(x=x, y=y, z=0.0) for x, y in corners]
    polygon = _TYPES["geometry_msgs/msg/Polygon"](points=points)
    return _TYPES[POLYGON](header=header(stamp, frame_id), polygon=polygon)


def box_of(message: Any) -> Box:
    """Bounds of a PolygonStamped's points, px."""
    xs = [float(p.x) for p in message.polygon.points]
    ys = [float(p.y) for p in message.polygon.points]
    return Box(min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys))
