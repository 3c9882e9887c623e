# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Why nothing comes in on a topic, and what to start the node with instead."""

from __future__ import annotations

from rclpy.node import Node

COMPRESSED = "/compressed"
IMAGE, COMPRESSED_IMAGE = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
MOST_NAMED = 3  # topics


def waiting_on(node: Node, topic: str, kind: str, reliability: str) -> str:
    """What an image input waits on, who publishes there, and what to change, for a log.

    Args:
        node: asks the graph.
        topic: the input's full name.
        kind: "Image" or "CompressedImage".
        reliability: that is asked for.
    """
    return (
        f"waiting on {topic} ({kind}, {reliability}); its publishers: "
        f"{publishers_of(node, topic) or 'none'}{_way_out(node, topic, kind)}"
    )


def publishers_of(node: Node, topic: str) -> str:
    """Name, type and reliability of each publisher on a topic; empty without any."""
    return ", ".join(
        f"{info.node_name} ({info.topic_type}, {info.qos_profile.reliability.name.lower()})"
        for info in node.get_publishers_info_by_topic(topic)
    )


def _way_out(node: Node, topic: str, kind: str) -> str:
    """What the node is to be started with, from "." or "," on."""
    base = topic.removesuffix(COMPRESSED)
    here = _types_published(node, topic)
    if kind == "Image" and COMPRESSED_IMAGE in here:
        return (
            f". That is a compressed image: start with -r image:={base} "
            "-p image_transport:=compressed"
        )
    if kind == "Image" and COMPRESSED_IMAGE in _types_published(node, base + COMPRESSED):
        return f". There is {base}{COMPRESSED}: start with -p image_transport:=compressed"
    if kind != "Image" and IMAGE in _types_published(node, base):
        return f". There is {base}: start with -p image_transport:=raw"
    if here:
        return ""
    wanted = IMAGE if kind == "Image" else COMPRESSED_IMAGE
    others = [name for name in _published(node, wanted) if name != topic]
    shown = ", ".join(others[:MOST_NAMED])
    example = others[0].removesuffix(COMPRESSED) if others else "/your/camera/image_raw"
    return f", remap with -r image:={example}" + (f" ({kind} is on {shown})" if shown else "")


def _types_published(node: Node, topic: str) -> set[str]:
    return {info.topic_type for info in node.get_publishers_info_by_topic(topic)}


def _published(node: Node, kind: str) -> list[str]:
    """Topics of a type that another node publishes, by name."""
    own = f"{node.get_fully_qualified_name()}/"
    return sorted(
        name
        for name, kinds in node.get_topic_names_and_types()
        if kind in kinds and not name.startswith(own) and node.count_publishers(name) > 0
    )
