# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Both parameter tables (the tracker's and the node's) as ROS parameters."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any, TypeVar

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from het_ros.ros.images import Reading
from het_ros.tracking.parameter import Parameter, check_parameters, parameter, parameters_of

Configuration = TypeVar("Configuration")
LARGEST_INT = 2**63 - 1


@dataclass(frozen=True)
class NodeConfig:
    """Every setting of the node that is none of the tracker's.

    Raises:
        ValueError: a value is of the wrong type or outside its range.
    """

    autostart: bool = parameter(
        True,
        "configure and activate at start; false leaves both to a lifecycle manager",
        read_only=True,
    )
    image_transport: str = parameter(
        "raw",
        "what is read: Image on `image`, or CompressedImage on `image/compressed`",
        choices=("raw", "compressed"),
        read_only=True,
    )
    tracker: str = parameter(
        "het",
        "het, or paper: the paper's tracker with the paper's constants, of the tracker's "
        "parameters only `seed`; with the next box",
        choices=("het", "paper"),
    )
    reliability: str = parameter(
        "auto",
        "asked for of images and depth: auto takes the best that all their publishers offer",
        choices=("auto", "reliable", "best_effort"),
        read_only=True,
    )
    white_level: int = parameter(
        65535,
        "value of a 16-bit image that counts as white; 4095 for a 12-bit camera",
        low=1,
        high=65535,
    )
    max_megapixels: float = parameter(
        50.0, "larger images are refused", unit="Mpx", low=0.001, high=1000.0
    )
    max_gap: float = parameter(
        2.0, "a longer gap between two images loses the track", unit="s", low=0.02, high=3600.0
    )
    jump_back: float = parameter(
        1.0,
        "a stamp older than the newest by this resets the track; by less, the frame is dropped",
        unit="s",
        low=0.0,
        high=3600.0,
    )
    ring_seconds: float = parameter(
        1.0,
        "how long images are kept for boxes that come late; 0 keeps the newest only",
        unit="s",
        low=0.0,
        high=60.0,
    )
    ring_megabytes: float = parameter(
        200.0,
        "memory for them; over it the oldest are kept as JPEG, then dropped",
        unit="MB",
        low=0.0,
        high=10000.0,
    )
    box_tolerance: float = parameter(
        0.2,
        "a box starts on the image nearest to its stamp, if it is as near as this",
        unit="s",
        low=0.0,
        high=10.0,
    )
    rectified: bool = parameter(
        False, "the images are rectified: camera_info's P holds for them and no distortion"
    )
    depth_tolerance: float = parameter(
        0.05,
        "a depth image is used for an image whose stamp is as near as this",
        unit="s",
        low=0.0,
        high=10.0,
    )
    depth_wait: float = parameter(
        0.1,
        "an image waits for its depth image at most this long, where depth comes in; 0: not at "
        "all, and ~/target_pose of that image follows when its depth comes",
        unit="s",
        low=0.0,
        high=2.0,
    )
    depth_witness: bool = parameter(
        True,
        "with depth, whatever else comes into the box, a column before the target or the wall "
        "behind it, is not followed; false where the depth is unreliable",
    )
    latency_ahead: float = parameter(
        0.0,
        "box, pose and place are published as they will be this much after their image, whose "
        "stamp they keep: about the time in which the robot reacts",
        unit="s",
        low=0.0,
        high=1.0,
    )
    debug_rate: float = parameter(
        10.0,
        "most debug images a second; they are drawn only for subscribers",
        unit="1/s",
        low=0.1,
        high=1000.0,
    )
    diagnostics_period: float = parameter(
        1.0,
        "time between two messages on /diagnostics",
        unit="s",
        low=0.1,
        high=60.0,
        read_only=True,
    )
    image_timeout: float = parameter(
        5.0,
        "no new image for this long: the log says why, ~/status says LOST (IDLE without a "
        "track) and the reason once a second until images come again; 0: never",
        unit="s",
        low=0.0,
        high=3600.0,
    )

    def __post_init__(self) -> None:
        check_parameters(self)

    @property
    def reading(self) -> Reading:
        """How images are read."""
        return Reading(self.white_level, self.max_megapixels * 1e6)


def declare(node: Node, configuration: Configuration) -> None:
    """Declare every field of a configuration as a parameter, its values as defaults.

    Raises:
        rclpy.exceptions.ParameterException: an override is of the wrong type or out of range.
    """
    for declared in parameters_of(type(configuration)):
        value = getattr(configuration, declared.name)
        node.declare_parameter(
            declared.name,
            list(value) if isinstance(value, tuple) else value,
            descriptor_of(declared),
        )


def read(node: Node, configuration: type[Configuration], **changed: Any) -> Configuration:
    """The configuration that the node's parameters make, ``changed`` fields taken instead.

    Raises:
        ValueError: the values do not fit together or are outside their ranges.
    """
    values = {}
    for declared in parameters_of(configuration):
        value = changed.get(declared.name, node.get_parameter(declared.name).value)
        values[declared.name] = tuple(value) if isinstance(declared.default, tuple) else value
    return configuration(**values)


def descriptor_of(declared: Parameter) -> ParameterDescriptor:
    """Description, unit, range, choices and read-only flag, as ``ros2 param describe`` shows."""
    descriptor = ParameterDescriptor(
        description=f"{declared.doc} [{declared.unit}]" if declared.unit else declared.doc,
        read_only=declared.read_only,
    )
    if declared.choices:
        descriptor.additional_constraints = f"one of: {', '.join(declared.choices)}"
    if declared.low is None and declared.high is None:
        return descriptor
    if isinstance(declared.default, int):
        low = -LARGEST_INT if declared.low is None else int(declared.low)
        high = LARGEST_INT if declared.high is None else int(declared.high)
        descriptor.integer_range = [IntegerRange(from_value=low, to_value=high, step=0)]
    else:
        largest = sys.float_info.max
        low = -largest if declared.low is None else float(declared.low)
        high = largest if declared.high is None else float(declared.high)
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=low, to_value=high, step=0.0)
        ]
    return descriptor
