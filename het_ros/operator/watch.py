# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One tracker as browsers see it: its subscriptions, open while anybody looks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped, TwistWithCovarianceStamped
from rcl_interfaces.msg import Log
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CompressedImage, Image

from het_ros.operator.discovery import IMAGES, find_images
from het_ros.operator.pictures import Picture
from het_ros.ros.image_stream import NEWEST_ONLY
from het_ros.ros.losses import Losses
from het_ros.ros.messages import (
    BoxError,
    box_from_polygon,
    header_of,
    polygon_from_box,
    stamp_ns,
)
from het_ros.ros.status import status_values
from het_ros.tracking.box import Box

RELIABLE = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
WITH_BOX = ("TRACKING", "COASTING")
WARN = 30  # level of rcl_interfaces/Log
LONGEST_LINE = 1000  # letters of a tracker's log
PENDING = 5  # frames whose box, velocity and status have not all come


class Tracks:
    """Puts box, velocity and status of one frame together; they come on three topics.

    Attributes:
        state: of the newest frame; empty before the first.
    """

    def __init__(self) -> None:
        self.state = ""
        self._pending: dict[int, dict[str, Any]] = {}

    def add(self, stamp: int, **parts: Any) -> list[dict[str, Any]]:
        """Take a part of a frame's answer; the messages that are complete by it, in order.

        A frame that lacks a part is complete when a newer one is and there is no hope left.
        """
        self._pending.setdefault(stamp, {}).update(parts)
        frame, done = self._pending[stamp], []
        if _whole(frame) or len(self._pending) > PENDING:
            for older in sorted(s for s in self._pending if s <= stamp):
                known = self._pending.pop(older)
                if "state" in known:
                    done.append({"type": "track", "stamp": str(older), **EMPTY, **known})
        while len(self._pending) > PENDING:  # stamps that jumped back
            self._pending.pop(next(iter(self._pending)))
        if done:
            self.state = done[-1]["state"]
        return done


EMPTY = {"box": None, "velocity": None}


def _whole(frame: dict[str, Any]) -> bool:
    if "state" not in frame:
        return False
    return frame["state"] not in WITH_BOX or ("box" in frame and "velocity" in frame)


class Watch:
    """The topics of one tracker; made and used in the thread that spins the node.

    Args:
        node: subscribes.
        tracker: full name of the tracker's node.
        on_message: is given what is to be told to the browsers.
        on_picture: is given each camera image.
    """

    def __init__(
        self,
        node: Node,
        tracker: str,
        on_message: Callable[[dict[str, Any]], None],
        on_picture: Callable[[Picture], None],
    ) -> None:
        self.tracks = Tracks()
        self.images = ("", "")
        self._node = node
        self._tracker = tracker
        self._on_message, self._on_picture = on_message, on_picture
        self._camera: Any = None
        self._losses = Losses(lambda: int(self._camera.get_publisher_count()))
        self._came = 0
        topics = (
            (f"{tracker}/status", DiagnosticArray, self._on_status),
            (f"{tracker}/box", PolygonStamped, self._on_box),
            (f"{tracker}/velocity", TwistWithCovarianceStamped, self._on_velocity),
            ("/rosout", Log, self._on_log),
        )
        self._open = [
            node.create_subscription(kind, topic, callback, RELIABLE)
            for topic, kind, callback in topics
        ]
        self._boxes = node.create_publisher(PolygonStamped, f"{tracker}/init_box", RELIABLE)

    def start(self, box: Box, stamp: int, replace: bool) -> None:
        """Send a box on the image of a stamp, ns.

        Raises:
            ValueError: nobody takes boxes, or a track is running and is not to be replaced.
        """
        if not self._boxes.get_subscription_count():
            raise ValueError(f"{self._tracker} takes no boxes now")
        if self.tracks.state in WITH_BOX and not replace:
            raise ValueError("a track is running: replace it?")
        self._boxes.publish(polygon_from_box(box, header_of(stamp)))

    def find_camera(self) -> None:
        """Subscribe to what the tracker reads, as soon as that is known and when it changes."""
        found = find_images(self._node, self._tracker)
        if not found[0] or found == self.images:
            return
        self._close_camera()
        self.images = found
        kind = Image if found[1] == IMAGES[0] else CompressedImage
        self._camera = self._node.create_subscription(kind, found[0], self._on_image, NEWEST_ONLY)

    def close(self) -> None:
        """Take all of it away."""
        for subscription in self._open:
            self._node.destroy_subscription(subscription)
        self._open.clear()
        self._node.destroy_publisher(self._boxes)
        self._close_camera()

    def _close_camera(self) -> None:
        if self._camera is not None:
            self._node.destroy_subscription(self._camera)
            self._camera, self.images = None, ("", "")

    def _on_image(self, message: Image | CompressedImage, info: dict[str, Any]) -> None:
        self._losses.take(info.get("publication_sequence_number"))
        self._came += 1
        self._on_picture(Picture(message, self._came + self._losses.count))

    def _on_status(self, message: DiagnosticArray) -> None:
        try:
            values = status_values(message)
            numbers = {name: float(values[name]) for name in ("score", "latency_ms", "age_s")}
            words = {name: values[name] for name in ("state", "reason")}
        except (LookupError, ValueError):
            return  # somebody else's status
        self._add(message.header, **numbers, **words)

    def _on_box(self, message: PolygonStamped) -> None:
        try:
            box = box_from_polygon(message)
        except BoxError:
            return
        self._add(message.header, box=[box.x, box.y, box.w, box.h])

    def _on_velocity(self, message: TwistWithCovarianceStamped) -> None:
        linear = message.twist.twist.linear
        self._add(message.header, velocity=[linear.x, linear.y])

    def _on_log(self, message: Log) -> None:
        """What the tracker says, a refusal for example, as it is written."""
        if message.name == self._tracker.strip("/").replace("/", "."):
            warning, text = message.level >= WARN, message.msg[:LONGEST_LINE]
            self._on_message({"type": "log", "warning": warning, "text": text})

    def _add(self, header: Any, **parts: Any) -> None:
        for message in self.tracks.add(stamp_ns(header), **parts):
            self._on_message(message)
