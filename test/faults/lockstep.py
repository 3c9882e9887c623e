# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera that sends a disturbed stream to the installed tracker, one frame after the other."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import cv2
import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import QoSProfile
from ros.streams import Camera, box_message, image_message
from sensor_msgs.msg import Image
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from het_ros import Box
from het_ros.faults.disturb import SECOND, Delivery, steady
from het_ros.ros.messages import box_from_polygon, header_of, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.footage import Footage, open_footage

# Every image arrives, and what the node counts is told ten times a second.
TRACKER = (
    "--ros-args",
    "-p",
    "qos_overrides./image.subscription.reliability:=reliable",
    "-p",
    "diagnostics_period:=0.1",
)


def header(stamp: int) -> Header:
    return header_of(stamp, "camera")


COUNTED = ("processed", "duplicate", "late", "unreadable", "skipped")


@dataclass
class LockStep:
    """Sends and waits, so that nothing depends on how fast the machine is.

    A frame that must be answered is waited for; of the others only the count is awaited.
    """

    graph: object
    footage: Footage
    camera: Camera
    counts: dict[str, int] = field(default_factory=dict)
    before: dict[str, int] = field(default_factory=dict)
    first_stamp: int = 1000 * SECOND
    newest: int = -1
    sent: int = 0
    reports: int = 0

    @classmethod
    def connect(cls, graph, footage: Footage) -> LockStep:
        camera = Camera(context=graph.context)
        camera.destroy_publisher(camera.images)
        camera.images = camera.create_publisher(Image, "image", QoSProfile(depth=10))
        made = cls(graph, footage, graph.add(camera))
        made.reset = camera.create_client(Trigger, "tracker/reset")
        camera.create_subscription(DiagnosticArray, "/diagnostics", made._on_diagnostics, 10)
        camera.meet(graph)
        return made

    def begin(self) -> None:
        """A stream that has nothing to do with the one before: no track, a day later."""
        self.graph.spin_until(self.reset.service_is_ready, "the service")
        answer = self.reset.call_async(Trigger.Request())
        self.graph.spin_until(answer.done, "a reset")
        fresh = self.reports + 2
        self.graph.spin_until(lambda: self.reports >= fresh, "counts of now")
        self.before, self.sent, self.newest = dict(self.counts), 0, -1
        self.first_stamp += 86400 * SECOND
        for messages in self.camera.got.values():
            messages.clear()

    def steady(self, frames: int) -> list[Delivery]:
        return steady(frames, 30.0, self.first_stamp)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        values = status_values(message)
        self.reports += 1
        self.counts = {name: int(values[name]) for name in COUNTED}

    def counted(self, *names: str) -> int:
        """How many frames of these kinds since :meth:`begin`."""
        return sum(self.counts.get(name, 0) - self.before.get(name, 0) for name in names)

    def send(self, delivery: Delivery, answered: bool = True) -> None:
        pixels = pixels_of(self.footage, delivery.frame)
        self.camera.images.publish(image_message(pixels, header(delivery.stamp)))
        self.sent += 1
        if answered:
            self.graph.spin_until(
                lambda: any(
                    stamp_ns(s.header) == delivery.stamp for s in self.camera.got["status"]
                ),
                f"a status for frame {delivery.frame}",
            )
        else:
            self.all_counted()

    def play(self, stream: Iterable[Delivery]) -> None:
        """Send a stream, of whose frames those with a newer stamp than all before are answered."""
        for delivery in stream:
            self.send(delivery, delivery.stamp > self.newest)
            self.newest = max(self.newest, delivery.stamp)

    def follow(self, stream: list[Delivery]) -> None:
        """Send a stream, and a box for its first frame."""
        self.play(stream[:1])
        self.start(stream[0])
        self.play(stream[1:])

    def start(self, delivery: Delivery) -> None:
        """A box for a frame that was sent."""
        got = self.camera.got
        before = {topic: len(got[topic]) for topic in ("box", "status")}
        self.send_box(delivery)
        self.graph.spin_until(
            lambda: all(len(got[topic]) > count for topic, count in before.items()), "a box"
        )

    def send_box(self, delivery: Delivery) -> None:
        truth = self.footage.truth[delivery.frame]
        self.camera.boxes.publish(box_message(truth.as_tuple(), header(delivery.stamp)))

    def all_counted(self) -> None:
        """Wait until /diagnostics accounts for every frame that was sent."""
        self.graph.spin_until(
            lambda: self.counted(*COUNTED) >= self.sent,
            f"{self.sent} frames in /diagnostics, not {self.counts}",
        )

    def state(self) -> str:
        return status_values(self.camera.got["status"][-1])["state"]

    def overlaps(self, stream: Iterable[Delivery]) -> list[float]:
        """Overlap with the truth of each delivery, 0 where no box was published."""
        boxes = {stamp_ns(b.header): box_from_polygon(b) for b in self.camera.got["box"]}
        return [self._overlap(boxes.get(d.stamp), self.footage.truth[d.frame]) for d in stream]

    def _overlap(self, box: Box | None, truth: Box) -> float:
        return 0.0 if box is None else box.iou(truth)


def pixels_of(footage: Footage, frame: int) -> np.ndarray:
    return cv2.imread(str(footage.images[frame]))


def crossing(sequences) -> Footage:
    """A pedestrian on a crossing, real footage with truth."""
    return open_footage(sequences / "Crossing")
