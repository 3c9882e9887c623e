# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Images, boxes, calibrations, depth and parameters: either the right thing or the one error."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import Image

from het_ros import Box, TrackerConfig
from het_ros.ros.depth import DepthError, depth_in, metres_of
from het_ros.ros.images import ImageError, decode, to_array
from het_ros.ros.messages import (
    BoxError,
    box_from_polygon,
    box_from_roi,
    polygon_from_box,
    roi_from_box,
)
from het_ros.ros.optics import CameraError, ray_of
from het_ros.ros.parameters import NodeConfig
from het_ros.tracking.parameter import parameters_of

from .cases import cases, counted
from .sane import check_message
from .strategies import (
    FLOAT64,
    anything,
    camera_infos,
    compressed_images,
    depth_images,
    images,
    names,
    polygons,
    regions,
    right_values,
)

BOXES = st.builds(
    Box,
    st.floats(-1e6, 1e6),
    st.floats(-1e6, 1e6),
    st.floats(1e-3, 1e6),
    st.floats(1e-3, 1e6),
)


@cases(150)
@given(images(), st.integers(1, 65535))
@counted
def test_any_image_is_pixels_or_an_image_error(message, white):
    try:
        pixels = to_array(message, white)
    except ImageError:
        return
    assert pixels.dtype == np.uint8
    assert pixels.shape[:2] == (message.height, message.width)
    assert pixels.ndim == 2 or pixels.shape[2] == 3


@cases(2)
@given(
    st.sampled_from(["bgr8", "mono16", "bayer_rggb8", "nv12", "yuyv", "rgba8"]),
    st.sampled_from([(4000, 3000), (20000, 2), (2, 20000), (6000, 2)]),
)
@counted
def test_huge_images(encoding, size):
    width, height = size
    step = width * {"bgr8": 3, "mono16": 2, "yuyv": 2, "rgba8": 4}.get(encoding, 1)
    rows = height * 3 // 2 if encoding == "nv12" else height
    message = Image(
        encoding=encoding, width=width, height=height, step=step, data=bytes(rows * step)
    )
    assert to_array(message).shape[:2] == (height, width)


@cases(100)
@given(compressed_images())
@counted
def test_any_compressed_image_is_pixels_or_an_image_error(message):
    try:
        pixels = decode(message)
    except ImageError:
        return
    assert pixels.dtype == np.uint8 and pixels.size
    assert pixels.ndim == 2 or pixels.shape[2] == 3


@cases(150)
@given(polygons())
@counted
def test_any_polygon_is_a_box_or_a_box_error(message):
    try:
        box = box_from_polygon(message)
    except BoxError:
        return
    assert box.w > 0 and box.h > 0
    check_message("box", polygon_from_box(box, message.header))


@cases(50)
@given(regions)
@counted
def test_any_region_is_a_box_or_a_box_error(message):
    try:
        box = box_from_roi(message)
    except BoxError:
        return
    assert (box.x, box.y) == (message.x_offset, message.y_offset)
    assert box.w > 0 and box.h > 0


@cases(50)
@given(BOXES, st.integers(1, 5000), st.integers(1, 5000))
@counted
def test_a_region_lies_inside_the_image(box, width, height):
    try:
        roi = roi_from_box(box, width, height)
    except BoxError:
        return
    assert 0 < roi.width <= width - roi.x_offset
    assert 0 < roi.height <= height - roi.y_offset


@cases(150)
@given(camera_infos(), st.floats(-200, 400), st.floats(-200, 400), st.booleans())
@counted
def test_any_calibration_gives_a_unit_ray_or_a_camera_error(info, x, y, rectified):
    try:
        ray = ray_of((x, y), info, (160, 120), rectified)
    except CameraError:
        return
    assert ray.shape == (3,) and np.isfinite(ray).all()
    assert np.linalg.norm(ray) == pytest.approx(1)


@cases(100)
@given(depth_images(), BOXES | st.just(Box(60, 40, 20, 32)))
@counted
def test_any_depth_image_gives_metres_or_an_error(message, box):
    try:
        metres = metres_of(message)
        depth = depth_in(box, (160, 120), metres)
    except (ImageError, DepthError):
        return
    assert np.isfinite(depth) and depth > 0


def check_parameter(configuration, name, value):
    declared = next(p for p in parameters_of(configuration) if p.name == name)
    try:
        made = configuration(**{name: value})
    except ValueError as error:
        assert str(error)
        return
    declared.check(getattr(made, name))


@cases(200)
@given(st.data())
@counted
def test_any_value_of_a_parameter_is_taken_or_refused(data):
    configuration = data.draw(st.sampled_from([TrackerConfig, NodeConfig]))
    name = data.draw(st.sampled_from(names(configuration)))
    declared = next(p for p in parameters_of(configuration) if p.name == name)
    check_parameter(configuration, name, data.draw(anything | right_values(declared)))


@cases(50)
@given(st.dictionaries(st.sampled_from(names(TrackerConfig)), anything | FLOAT64, max_size=6))
@counted
def test_any_values_together_are_taken_or_refused(values):
    try:
        config = TrackerConfig(**values)
    except ValueError:
        return
    for declared in parameters_of(TrackerConfig):
        declared.check(getattr(config, declared.name))
