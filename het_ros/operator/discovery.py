# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which trackers there are in the ROS graph, and which images each of them reads."""

from __future__ import annotations

from rclpy.node import Node

STATUS, BOX = "diagnostic_msgs/msg/DiagnosticArray", "geometry_msgs/msg/PolygonStamped"
IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")


def find_trackers(node: Node) -> list[str]:
    """Full names of the nodes that publish ``~/status`` and take ``~/init_box``, sorted."""
    topics = dict(node.get_topic_names_and_types())
    names = [topic[: -len("/status")] for topic in topics if topic.endswith("/status")]
    return sorted(
        name
        for name in names
        if STATUS in topics[f"{name}/status"]
        and BOX in topics.get(f"{name}/init_box", ())
        and node.count_publishers(f"{name}/status") > 0
        and node.count_subscribers(f"{name}/init_box") > 0
    )


def find_images(node: Node, tracker: str) -> tuple[str, str]:
    """Topic and type of the images that a tracker reads; empty where it is not known.

    A remapping of this node's own ``image`` decides. Else it is what the tracker subscribes to;
    a tracker that shares another one's images has no subscription, and its neighbours' is taken.
    """
    own = node.resolve_topic_name("image")
    if own != node.get_namespace().rstrip("/") + "/image":
        kinds = dict(node.get_topic_names_and_types()).get(own, [])
        return next(((own, kind) for kind in kinds if kind in IMAGES), ("", ""))
    space, _, _ = tracker.rpartition("/")
    neighbours = [name for name in find_trackers(node) if name.rpartition("/")[0] == space]
    for name in (tracker, *neighbours):
        found = _images_of(node, name)
        if found:
            return found[0]
    return "", ""


def _images_of(node: Node, tracker: str) -> list[tuple[str, str]]:
    """Image topics of one node, the camera's before what is called depth."""
    space, _, name = tracker.rpartition("/")
    try:
        topics = node.get_subscriber_names_and_types_by_node(name, space or "/")
    except Exception:  # rclpy has several kinds for a node that has just gone
        return []
    found = [(topic, kind) for topic, kinds in topics for kind in kinds if kind in IMAGES]
    return sorted(found, key=lambda pair: ("depth" in pair[0], pair[1] == IMAGES[0]))
