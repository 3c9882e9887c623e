# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where images come in: one subscription for every node of a process that looks at them."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from het_ros.ros.frames import Conversion, Frame, ImageMessage
from het_ros.ros.hints import Hints
from het_ros.ros.losses import Losses
from het_ros.ros.messages import stamp_ns
from het_ros.ros.offers import OfferedSubscription
from het_ros.ros.silence import waiting_on

# Depth 1: with a deeper queue a busy node works on old images, and latency grows by the depth.
NEWEST_ONLY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
Look = Callable[[Frame], None]
NO_TIME = (
    "images carry no stamp, and under use_sim_time there is no time either: nobody publishes "
    "/clock. Set header.stamp, publish /clock, or start with use_sim_time:=false"
)


class ImageStream:
    """Images on a node's topic, taken while anybody looks and converted once for all who do.

    Args:
        node: subscribes, with its remappings and QoS parameters; active or not.
        compressed: whether CompressedImage is read instead of Image.
        reliability: that is asked for, see :class:`OfferedSubscription`.
        hints: for what is wrong with the images.
    """

    def __init__(self, node: Node, compressed: bool, reliability: str, hints: Hints) -> None:
        self._node = node
        self._kind = CompressedImage if compressed else Image
        self._suffix = "/compressed" if compressed else ""
        self._reliability = reliability
        self._hints = hints
        self._looking: list[Look] = []
        self._losses = Losses(lambda: self._subscription.publishers)

    def join(self, look: Look) -> None:
        """Call ``look`` with every frame from now on."""
        self._looking.append(look)
        if len(self._looking) == 1:
            self._subscribe()

    def leave(self, look: Look) -> None:
        """Call ``look`` no more."""
        self._looking.remove(look)
        if not self._looking:
            self._subscription.destroy()

    def take(self, message: ImageMessage) -> None:
        """Show one image to all who look."""
        arrival = time.monotonic()
        shared = Conversion(message) if len(self._looking) > 1 else None
        frame = Frame(message, self._stamp_of(message.header), arrival, shared)
        for look in tuple(self._looking):
            look(frame)
        if shared is not None:
            shared.close()

    def _on_message(self, message: ImageMessage, info: dict[str, Any]) -> None:
        self._losses.take(info.get("publication_sequence_number"))
        self.take(message)

    @property
    def dropped(self) -> int:
        """Images that were published and never came: lost, or replaced by newer ones."""
        return self._losses.count

    def waiting_on(self) -> str:
        """What is waited for while no image comes, for a log."""
        kind, asked = self._kind.__name__, self._subscription.reliability
        return waiting_on(self._node, self.topic, kind, asked)

    @property
    def topic(self) -> str:
        """Where images are taken from, while anybody looks."""
        return self._subscription.topic

    def _subscribe(self) -> None:
        topic = self._node.resolve_topic_name("image") + self._suffix
        self._subscription = OfferedSubscription(
            self._node, self._kind, topic, self._on_message, NEWEST_ONLY, self._reliability
        )

    def _stamp_of(self, header: Header) -> int:
        """The image's stamp, or the time of arrival where a driver leaves it at zero, ns."""
        stamp = stamp_ns(header)
        if stamp == 0:
            self._hints.once(
                "no stamp", "images carry no stamp: the time of arrival is taken, set header.stamp"
            )
            stamp = int(self._node.get_clock().now().nanoseconds)
            if stamp == 0:
                self._hints.once("no time", NO_TIME)
        return stamp
