# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Messages and a camera for the tests of the node."""

from __future__ import annotations

import cv2
import numpy as np
from geometry_msgs.msg import Point32, PolygonStamped
from graph import PATIENCE
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from het_ros.ros.messages import header_of
from het_ros.ros.status import status_values
from het_ros.ros.tracker_node import OUTPUTS, TrackerNode
from het_ros.tools.handshake import meet
from het_ros.tools.interrupt import StopRequest

FRAME_TIME = 1 / 30  # s


def header_at(seconds: float, frame_id: str = "camera") -> Header:
    return header_of(round(seconds * 1e9), frame_id)


def image_message(pixels: np.ndarray, header: Header) -> Image:
    height, width = pixels.shape[:2]
    return Image(
        header=header,
        height=height,
        width=width,
        encoding="mono8" if pixels.ndim == 2 else "bgr8",
        step=pixels.strides[0],
        data=np.ascontiguousarray(pixels).tobytes(),
    )


def compressed(pixels, suffix, name=None) -> CompressedImage:
    return CompressedImage(
        format=name or suffix, data=cv2.imencode(f".{suffix}", pixels)[1].tobytes()
    )


def box_message(box, header: Header | None = None) -> PolygonStamped:
    x, y, w, h = map(float, box)
    message = PolygonStamped(header=header or Header())
    message.polygon.points = [Point32(x=x, y=y), Point32(x=x + w, y=y + h)]
    return message


class ByHand:
    """A tracker node without an executor: fed by calls, its outputs in lists."""

    def __init__(self, graph, **options) -> None:
        self.sent: list[tuple[str, object]] = []
        self.node = graph.keep(
            TrackerNode(
                context=graph.context,
                tap=lambda topic, message: self.sent.append((topic, message)),
                **options,
            )
        )

    def image(self, pixels: np.ndarray, seconds: float, frame_id: str = "camera") -> dict:
        """Feed one image; what the node published for it, by topic."""
        return self.feed(image_message(pixels, header_at(seconds, frame_id)))

    def feed(self, message: Image | CompressedImage) -> dict:
        del self.sent[:]
        self.node.on_image(message)
        return dict(self.sent)

    def box(self, box, seconds: float = 0.0) -> dict:
        """Feed a box, its stamp in s; what the node published for it, by topic."""
        del self.sent[:]
        self.node.on_init_box(box_message(box, header_at(seconds)))
        return dict(self.sent)

    def state_of(self, outputs: dict) -> str:
        return status_values(outputs["status"])["state"]


class Camera(Node):
    """Publishes images and boxes, and keeps all that a node ``tracker`` answers."""

    def __init__(self, compressed: bool = False, **options) -> None:
        super().__init__("camera", **options)
        kind, topic = (CompressedImage, "image/compressed") if compressed else (Image, "image")
        best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.images = self.create_publisher(kind, topic, best_effort)
        self.boxes = self.create_publisher(PolygonStamped, "tracker/init_box", 10)
        self.got: dict[str, list] = {topic: [] for topic in OUTPUTS}
        self.inputs = [
            self.create_subscription(kind, f"tracker/{topic}", self.got[topic].append, 50)
            for topic, kind in OUTPUTS.items()
        ]

    def show(self, graph, image) -> None:
        """Publish an image until its status comes: a best-effort image may get lost on the way."""
        answered = len(self.got["status"])
        header = image.header
        for _ in range(20):
            self.images.publish(image)
            if graph.spins_until(
                lambda: any(s.header == header for s in self.got["status"][answered:]), 3
            ):
                return
        raise AssertionError(f"no status for the image of {header.stamp}")

    def meet(self, graph) -> None:
        """Return when camera and tracker know each other; before that, images get lost."""

        def spin(seconds: float) -> None:
            graph.executor.spin_once(timeout_sec=seconds)

        meet(self, "tracker", self.connected, spin, PATIENCE, StopRequest())

    def connected(self) -> bool:
        """Whether this camera has found the tracker: enough for who sends no images."""
        return (
            self.images.get_subscription_count() > 0
            and self.boxes.get_subscription_count() > 0
            and all(self.count_publishers(s.topic_name) > 0 for s in self.inputs)
        )
