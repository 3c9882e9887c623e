# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The node's outputs: publishers that make a message only when somebody is to get it."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import (
    PolygonStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TwistWithCovarianceStamped,
    Vector3Stamped,
)
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_msgs.msg import Float32

from het_ros.ros.quality import checked, overridable, publisher_events

Tap = Callable[[str, Any], None]

RELIABLE = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
# The outputs of every node, below its name.
OUTPUTS: dict[str, type] = {
    "box": PolygonStamped,
    "pose": PoseWithCovarianceStamped,
    "velocity": TwistWithCovarianceStamped,
    "velocity_in_scene": TwistWithCovarianceStamped,
    "status": DiagnosticArray,
    "score": Float32,
    "bearing": Vector3Stamped,
    "target_pose": PoseStamped,
    "target_pose_cov": PoseWithCovarianceStamped,
    "target_velocity": TwistWithCovarianceStamped,
    "debug_image": Image,
}


def make_publisher(node: Node, kind: type, topic: str) -> Any:
    """A reliable publisher that parameters may change; raises ValueError where they are wrong."""
    return checked(
        lambda: node.create_publisher(
            kind,
            topic,
            copy(RELIABLE),  # overrides are written into it
            event_callbacks=publisher_events(node, topic),
            qos_overriding_options=overridable(),
        ),
        node.resolve_topic_name(topic),
        "publisher",
    )


class Outputs:
    """Publishers by topic.

    Args:
        node: the node that publishes.
        kinds: message type of each topic below the node's name.
        tap: is given every message as ``tap(topic, message)``, subscribers or not.
    """

    def __init__(self, node: Node, kinds: dict[str, type], tap: Tap | None) -> None:
        self._node = node
        self._tap = tap
        self._publishers = {topic: self._publisher(topic, kind) for topic, kind in kinds.items()}

    def _publisher(self, topic: str, kind: type) -> Any:
        return make_publisher(self._node, kind, f"~/{topic}")

    def __contains__(self, topic: str) -> bool:
        return topic in self._publishers

    def heard(self, topic: str) -> bool:
        """Whether anybody subscribes."""
        return self._publishers[topic].get_subscription_count() > 0

    def send(self, topic: str, make: Callable[[], Any]) -> None:
        """Publish what ``make`` makes, unless nobody would get it or it makes None."""
        heard = self.heard(topic)
        if not heard and self._tap is None:
            return
        message = make()
        if message is None:
            return
        if self._tap is not None:
            self._tap(topic, message)
        if heard:
            self._publishers[topic].publish(message)

    def destroy(self) -> None:
        """Take the publishers away."""
        for publisher in self._publishers.values():
            self._node.destroy_publisher(publisher)
        self._publishers.clear()
