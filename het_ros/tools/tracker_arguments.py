# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How a tracker has to be started: to take a bag's images, with parameters."""

from __future__ import annotations

from collections.abc import Sequence

from het_ros.tools.bag_messages import COMPRESSED_TOPIC, IMAGE_TOPIC
from het_ros.tools.bag_reader import BagReader


def tracker_arguments(bag: BagReader, parameters: Sequence[str] = ()) -> list[str]:
    """ROS arguments that let the tracker read the bag's images, whatever their topic and kind.

    Args:
        bag: what it is to be fed with.
        parameters: more parameters, each as "name:=value".
    """
    transport, default = "raw", IMAGE_TOPIC
    if bag.compressed:
        transport, default = "compressed", COMPRESSED_TOPIC
    arguments = ["--ros-args", *parameter_arguments([f"image_transport:={transport}"])]
    if bag.image_topic not in ("", default):
        arguments += ["-r", f"{default}:={bag.image_topic}"]
    return arguments + parameter_arguments(parameters)


def parameter_arguments(parameters: Sequence[str]) -> list[str]:
    """ROS arguments, to come behind ``--ros-args``, of parameters as "name:=value"."""
    return [word for parameter in parameters for word in ("-p", parameter)]
