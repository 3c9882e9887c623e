# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What may come in from outside: images, boxes, numbers, of every kind and none."""

from __future__ import annotations

import math
from dataclasses import fields

import cv2
import numpy as np
from geometry_msgs.msg import Point32, PolygonStamped
from hypothesis import strategies as st
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, RegionOfInterest
from std_msgs.msg import Header

from het_ros.ros.images import ENCODINGS
from het_ros.tracking.parameter import Parameter

SIDES = st.sampled_from([1, 2, 3, 4, 5, 7, 16, 33, 64, 120]) | st.integers(1, 96)
UINT32 = st.sampled_from([0, 1, 2, 2**16, 2**31, 2**32 - 1]) | st.integers(0, 200)
# What a Point32 can hold: infinite and NaN as well.
FLOAT32 = st.floats(width=32) | st.sampled_from([0.0, -0.0, 1e-38, 3.4e38, -3.4e38, 1e9, -1e9])
PIXEL = st.floats(-300, 500, width=32)
FLOAT64 = st.floats() | st.sampled_from([0.0, 1e-300, 1e300, -1e300, 1.0])
TEXT = st.sampled_from(["", "camera", "/", "a" * 300, "ä\n%s{}"]) | st.text(
    st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=20
)


@st.composite
def pixels(draw, sides=SIDES) -> np.ndarray:
    """(H, W, 3) or (H, W) uint8: noise, constant, saturated, stripes; views and copies."""
    height, width = draw(sides), draw(sides)
    shape = (height, width, 3) if draw(st.booleans()) else (height, width)
    rng = np.random.default_rng(draw(st.integers(0, 2**20)))
    kind = draw(st.sampled_from(["noise", "constant", "smooth", "stripes", "saturated"]))
    if kind == "noise":
        image = rng.integers(0, 256, shape, np.uint8)
    elif kind == "constant":
        image = np.full(shape, draw(st.sampled_from([0, 1, 127, 254, 255])), np.uint8)
    elif kind == "smooth":
        image = cv2.GaussianBlur(rng.integers(0, 256, shape, np.uint8), (0, 0), 3)
    elif kind == "stripes":
        image = np.zeros(shape, np.uint8)
        image[:: draw(st.integers(2, 9))] = 255
    else:
        image = np.where(rng.random(shape) < 0.5, 0, 255).astype(np.uint8)
    view = draw(st.sampled_from(["itself", "flipped", "transposed", "every other", "read only"]))
    if view == "flipped":
        return image[::-1, ::-1]
    if view == "transposed":
        return image.swapaxes(0, 1)
    if view == "every other":
        return image[::2, ::2]
    if view == "read only":
        image.flags.writeable = False
    return image


no_image = st.sampled_from(
    [
        None,
        np.zeros((0, 0), np.uint8),
        np.zeros((0, 5, 3), np.uint8),
        np.zeros((5, 0), np.uint8),
        np.zeros((5, 5, 4), np.uint8),
        np.zeros((5, 5, 1), np.uint8),
        np.zeros(5, np.uint8),
        np.zeros((5, 5), np.float32),
        np.zeros((5, 5), np.int8),
        np.full((5, 5), np.nan),
        [[1, 2], [3, 4]],
    ]
)


@st.composite
def headers(draw) -> Header:
    header = Header(frame_id=draw(TEXT))
    header.stamp.sec = draw(st.integers(-(2**31), 2**31 - 1) | st.integers(0, 3))
    header.stamp.nanosec = draw(st.integers(0, 2**32 - 1))
    return header


@st.composite
def images(draw, header=None) -> Image:
    """An Image of any encoding with fitting data, of which something may then be wrong."""
    encoding = draw(st.sampled_from([*ENCODINGS, "32FC1", "", "jpeg"]) | TEXT)
    height, width = draw(SIDES), draw(SIDES)
    layout = ENCODINGS.get(encoding)
    pixel = layout.itemsize * layout.channels if layout else 4
    rows = height * (layout.plane_rows if layout else 2) // 2
    step = width * pixel + draw(st.sampled_from([0, 0, 0, 1, 7]))
    rng = np.random.default_rng(draw(st.integers(0, 2**20)))
    message = Image(
        header=header or draw(headers()),
        height=height,
        width=width,
        encoding=encoding,
        step=step,
        is_bigendian=draw(st.sampled_from([0, 0, 1, 255])),
        data=rng.integers(0, 256, rows * step, np.uint8).tobytes(),
    )
    for wrong in draw(st.lists(st.sampled_from(["size", "step", "data", "float"]), max_size=2)):
        if wrong == "size":
            message.height, message.width = draw(UINT32), draw(UINT32)
        elif wrong == "step":
            message.step = draw(UINT32)
        elif wrong == "float":
            numbers = draw(st.lists(st.floats(width=32), max_size=30))
            message.data = np.array(numbers, np.float32).tobytes()
        else:
            message.data = bytes(message.data)[: draw(st.integers(0, rows * step + 1))]
    return message


@st.composite
def compressed_images(draw, header=None) -> CompressedImage:
    """A JPEG or PNG, cut off or with bytes changed, or anything else."""
    suffix = draw(st.sampled_from(["jpg", "png", "bmp", "tiff", "webp"]))
    data = bytearray(cv2.imencode(f".{suffix}", draw(pixels()))[1].tobytes())
    for _ in range(draw(st.sampled_from([0, 0, 1, 3, 20]))):
        data[draw(st.integers(0, len(data) - 1))] = draw(st.integers(0, 255))
    if draw(st.booleans()):
        data = data[: draw(st.integers(0, len(data)))]
    if draw(st.integers(0, 9)) == 0:
        data = draw(st.binary(max_size=200))
    return CompressedImage(
        header=header or draw(headers()),
        format=draw(st.sampled_from(["jpeg", "png", "bgr8; jpeg compressed bgr8"]) | TEXT),
        data=bytes(data),
    )


@st.composite
def polygons(draw, header=None, coordinates=FLOAT32 | PIXEL) -> PolygonStamped:
    """Any number of any points."""
    points = draw(
        st.lists(st.tuples(coordinates, coordinates), max_size=6)
        | st.lists(st.tuples(PIXEL, PIXEL), min_size=2, max_size=4)
    )
    message = PolygonStamped(header=header or draw(headers()))
    message.polygon.points = [Point32(x=x, y=y, z=0.0) for x, y in points]
    return message


regions = st.builds(
    RegionOfInterest, x_offset=UINT32, y_offset=UINT32, width=UINT32, height=UINT32
)


@st.composite
def camera_infos(draw) -> CameraInfo:
    """A calibration: plausible, of another size, or nonsense in any field."""
    width, height = draw(st.sampled_from([(160, 120)]) | st.tuples(UINT32, UINT32))
    numbers = draw(st.sampled_from([st.floats(0.1, 500), FLOAT64]))
    info = CameraInfo(
        header=draw(headers()),
        width=width,
        height=height,
        distortion_model=draw(
            st.sampled_from(["plumb_bob", "rational_polynomial", "equidistant", "fisheye", ""])
            | TEXT
        ),
        d=draw(st.lists(numbers, max_size=14)),
        binning_x=draw(st.sampled_from([0, 1, 2]) | UINT32),
        binning_y=draw(st.sampled_from([0, 1, 2]) | UINT32),
        roi=draw(st.just(RegionOfInterest()) | regions),
    )
    if draw(st.booleans()):
        info.k = [150.0, 0.0, 80.0, 0.0, 150.0, 60.0, 0.0, 0.0, 1.0]
        info.p = [150.0, 0.0, 80.0, 0.0, 0.0, 150.0, 60.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    else:
        info.k = draw(st.lists(numbers, min_size=9, max_size=9))
        info.p = draw(st.lists(numbers, min_size=12, max_size=12))
    return info


@st.composite
def depth_images(draw, header=None) -> Image:
    """A depth image of either kind, or any other image."""
    if draw(st.integers(0, 3)) == 0:
        return draw(images(header))
    height, width = draw(st.sampled_from([(120, 160), (1, 1), (60, 80)]) | st.tuples(SIDES, SIDES))
    if draw(st.booleans()):
        values = draw(st.lists(st.integers(0, 65535), min_size=1, max_size=5))
        metres, encoding = np.resize(np.array(values, np.uint16), (height, width)), "16UC1"
    else:
        values = draw(st.lists(st.floats(width=32), min_size=1, max_size=5))
        metres, encoding = np.resize(np.array(values, np.float32), (height, width)), "32FC1"
    return Image(
        header=header or draw(headers()),
        height=height,
        width=width,
        encoding=encoding,
        step=metres.strides[0],
        data=metres.tobytes(),
    )


def right_values(declared: Parameter) -> st.SearchStrategy:
    """Values of a parameter that are of its type and in its range."""
    default = declared.default
    if isinstance(default, bool):
        return st.booleans()
    if isinstance(default, tuple):
        return st.lists(st.sampled_from(declared.choices), min_size=1, max_size=12).map(tuple)
    if isinstance(default, str):
        return st.sampled_from(declared.choices) if declared.choices else TEXT
    if isinstance(default, int):
        low = -(2**63) if declared.low is None else int(declared.low)
        high = 2**63 - 1 if declared.high is None else int(declared.high)
        return st.integers(low, high) | st.sampled_from([low, high, default])
    low = -1e300 if declared.low is None else float(declared.low)
    high = 1e300 if declared.high is None else float(declared.high)
    return st.floats(low, high) | st.sampled_from([low, high, default])


anything = (
    st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | FLOAT64
    | TEXT
    | st.lists(TEXT, max_size=3)
    | st.lists(FLOAT64, max_size=3)
    | st.binary(max_size=3)
    | st.none()
)


def is_finite(value: float) -> bool:
    return math.isfinite(value)


def names(configuration) -> list[str]:
    return [field.name for field in fields(configuration)]
