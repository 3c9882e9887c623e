# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Message classes by their names, and whether a bag means the same by a name."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from het_ros.tools.bag_reader import BagError, BagReader


def message_class(kind: str) -> Any:
    """The class of a type, e.g. sensor_msgs.msg.Image of "sensor_msgs/msg/Image".

    Raises:
        BagError: no such message is installed.
    """
    package, _, name = kind.partition("/msg/")
    try:
        return getattr(import_module(f"{package}.msg"), name)
    except (ImportError, AttributeError):
        raise BagError(f"{kind} is not installed here: install {package}") from None


def check_types(bag: BagReader, topics: list[str]) -> None:
    """Make sure that the bytes of some topics are what the installed types say.

    A publisher takes any bytes, so this is the only moment at which a wrong type can be told.

    Raises:
        BagError: a type is unknown, or the bag defines it in another way than ROS 2 Jazzy.
    """
    for topic in topics:
        kind = bag.topics[topic]
        # First the check: a package that a bag names is not imported unless it is Jazzy's own.
        if not bag.has_jazzys(topic):
            raise BagError(
                f"{bag.path}: {topic} has a {kind} that is not ROS 2 Jazzy's: "
                "convert the bag, or play it with the ROS release that recorded it"
            )
        message_class(kind)
