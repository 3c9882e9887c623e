# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where images come in: one subscription for every node of a process that looks at them."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from copy import copy
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from het_ros.ros.frames import Conversion, Frame, ImageMessage
from het_ros.ros.hints import Hints
from het_ros.ros.losses import Losses
from het_ros.ros.messages import stamp_ns
from het_ros.ros.quality import explain_silence, overridable, subscription_events

# Depth 1: with a deeper queue a busy node works on old images, and latency grows by the depth.
NEWEST_ONLY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
Look = Callable[[Frame], None]


class ImageStream:
    """Images on a node's topic, taken while anybody looks and converted once for all who do.

    Args:
        node: subscribes, with its remappings and QoS parameters; active or not.
        compressed: whether CompressedImage is read instead of Image.
        timeout: s after which the log says what is waited for if no image came; 0: never.
        hints: for what is wrong with the images.
    """

    def __init__(self, node: Node, compressed: bool, timeout: float, hints: Hints) -> None:
        self._node = node
        self._kind = CompressedImage if compressed else Image
        self._suffix = "/compressed" if compressed else ""
        self._timeout = timeout
        self._hints = hints
        self._looking: list[Look] = []
        self._open = ExitStack()
        self._came = False
        self._losses = Losses(lambda: int(self._subscription.get_publisher_count()))

    def join(self, look: Look) -> None:
        """Call ``look`` with every frame from now on."""
        self._looking.append(look)
        if len(self._looking) == 1:
            self._subscribe()

    def leave(self, look: Look) -> None:
        """Call ``look`` no more."""
        self._looking.remove(look)
        if not self._looking:
            self._open.close()

    def take(self, message: ImageMessage) -> None:
        """Show one image to all who look."""
        self._came = True
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

    def on_silence(self) -> None:
        """Once after the start: if no image came, say what is waited for."""
        self._silence.cancel()
        if not self._came:
            text = explain_silence(self._node, self._subscription, self._timeout)
            self._hints.once("silence", text)

    @property
    def topic(self) -> str:
        """Where images are taken from, while anybody looks."""
        return str(self._subscription.topic_name)

    def _subscribe(self) -> None:
        topic = self._node.resolve_topic_name("image") + self._suffix
        self._subscription = self._node.create_subscription(
            self._kind,
            topic,
            self._on_message,
            copy(NEWEST_ONLY),  # overrides are written into it
            event_callbacks=subscription_events(self._node, topic),
            qos_overriding_options=overridable(),
        )
        self._open.callback(self._node.destroy_subscription, self._subscription)
        if self._timeout > 0:
            steady = Clock(clock_type=ClockType.STEADY_TIME)  # runs under use_sim_time as well
            self._silence = self._node.create_timer(self._timeout, self.on_silence, clock=steady)
            self._open.callback(self._node.destroy_timer, self._silence)

    def _stamp_of(self, header: Header) -> int:
        """The image's stamp, or the time of arrival where a driver leaves it at zero, ns."""
        stamp = stamp_ns(header)
        if stamp == 0:
            self._hints.once(
                "no stamp", "images carry no stamp: the time of arrival is taken, set header.stamp"
            )
            return int(self._node.get_clock().now().nanoseconds)
        return stamp
