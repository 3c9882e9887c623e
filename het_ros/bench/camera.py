# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera at a steady rate, and the answers that come back to it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from het_ros.bench.footage import Footage
from het_ros.ros.debug_image import debug_message
from het_ros.ros.messages import polygon_from_box, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.handshake import Spin
from het_ros.tools.transport import use_profile
from het_ros.tracking.box import Box

QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)  # what camera drivers offer
FIRST_STAMP = 1000  # s
WARM_UP = 1.0  # s, that are not counted
LAG = 3  # periods that are made up for after a hold-up: no longer bursts than that
CALLBACKS = 6  # that an image brings about at most, in one process
GRACE = 1.0  # s, for answers that are on their way at the end

Made = TypeVar("Made", bound=Node)


@contextmanager
def spun(make: Callable[[], Made]) -> Iterator[tuple[Made, Spin]]:
    """The node that ``make`` makes, in a graph that ends with the block, and what spins it.

    It sends with the shipped profile of Fast DDS, and leaves signals to the caller.
    """
    use_profile()
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    node, executor = make(), SingleThreadedExecutor()
    executor.add_node(node)
    try:
        yield node, lambda seconds: executor.spin_once(timeout_sec=seconds)
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


class Camera(Node):
    """Publishes images and takes boxes and statuses, each with the time it took.

    Attributes:
        rate: frames/s.
        tracker: name of the tracker's node.
        boxes: s from there to the box, by stamp.
        own: s that the tracker says it took from arrival to publishing, by stamp.
        states: the track's state, by stamp.
    """

    def __init__(self, footage: Footage, rate: float, tracker: str = "tracker") -> None:
        super().__init__("camera")
        self.rate = rate
        self._messages = [debug_message(footage[i], Header()) for i in range(len(footage))]
        self._footage = footage
        self._images = self.create_publisher(Image, "image", QOS)
        self._init = self.create_publisher(PolygonStamped, f"{tracker}/init_box", 10)
        self.create_subscription(PolygonStamped, f"{tracker}/box", self._on_box, 50)
        self.create_subscription(DiagnosticArray, f"{tracker}/status", self._on_status, 50)
        self.tracker = tracker
        self._published: dict[int, float] = {}
        self._counted = range(0)  # stamps
        self.boxes: dict[int, float] = {}
        self.own: dict[int, float] = {}
        self.states: dict[int, str] = {}

    @property
    def sent(self) -> dict[int, float]:
        """When each image that counts was published, s, by its stamp, ns."""
        return {s: t for s, t in self._published.items() if s in self._counted}

    def connected(self) -> bool:
        """Whether the camera has found the tracker; see ``handshake`` for the other direction."""
        topics = (f"{self.tracker}/box", f"{self.tracker}/status")
        publishers = (self._images, self._init)
        return all(self.count_publishers(topic) > 0 for topic in topics) and all(
            publisher.get_subscription_count() > 0 for publisher in publishers
        )

    def start(self, box: Box) -> None:
        """Send the first box, for the newest image."""
        self._init.publish(polygon_from_box(box, Header()))

    def run(self, seconds: float, box: Box, spin: Spin, on_counting: Callable[[], None]) -> None:
        """Publish for so long, after a warm-up of ``WARM_UP`` s that does not count.

        Images are due at moments that are fixed from the start, and a late one goes at once. What
        the camera is late by more than ``LAG`` periods is given up, and the rate falls.

        Args:
            seconds: how long images are counted.
            box: the target in the first image.
            spin: serves callbacks for at most so many seconds.
            on_counting: called when the counting begins.
        """
        first, end = (round(s * self.rate) for s in (WARM_UP, WARM_UP + seconds))
        self._counted = range(self._stamp(first), self._stamp(end))
        due = time.perf_counter()
        for i in range(end):
            if i == first:
                on_counting()
            self._publish(i)
            if i == 0:
                self.start(box)
            due = max(due, time.perf_counter() - LAG / self.rate) + 1 / self.rate
            self._spin_until(due, spin)

    def finish(self, spin: Spin) -> None:
        """Take the answers that are still on their way."""
        self._spin_until(time.perf_counter() + GRACE, spin)

    def _stamp(self, index: int) -> int:
        return FIRST_STAMP * 10**9 + round(index * 1e9 / self.rate)

    def _publish(self, index: int) -> None:
        stamp = self._stamp(index)
        message = self._messages[self._footage.at(index)]
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
        self._published[stamp] = time.perf_counter()
        self._images.publish(message)

    def _spin_until(self, end: float, spin: Spin) -> None:
        """Serve callbacks until then, and some of a camera that is late."""
        for _ in range(CALLBACKS):
            spin(0.0)
        while (left := end - time.perf_counter()) > 0:
            spin(left)

    def _on_box(self, message: PolygonStamped) -> None:
        stamp = stamp_ns(message.header)
        if stamp in self._published and stamp not in self.boxes:
            self.boxes[stamp] = time.perf_counter() - self._published[stamp]

    def _on_status(self, message: DiagnosticArray) -> None:
        values = status_values(message)
        stamp = stamp_ns(message.header)
        self.own[stamp] = float(values["latency_ms"]) / 1e3
        self.states[stamp] = values["state"]
