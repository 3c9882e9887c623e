# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera for hours: a loop of footage with new boxes, and what came back in each stretch."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped
from rclpy.node import Node
from sensor_msgs.msg import Image

from het_ros.bench.camera import QOS
from het_ros.faults.loop import Shot
from het_ros.ros.debug_image import debug_message
from het_ros.ros.diagnostics import COUNTED
from het_ros.ros.messages import box_from_polygon, header_of, polygon_from_box, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tracking.box import Box

FIRST_STAMP = 1000 * 10**9  # ns
KEPT = 200  # frames whose answers are waited for
SEEN = 0.5  # visible part from which on the target counts as visible


@dataclass
class Stretch:
    """What was sent and answered since the last look.

    Attributes:
        sent: frames.
        boxes: new boxes.
        states: statuses by state.
        own: s from a frame's arrival at the node to its status, as the node says.
        trips: s from publishing a frame until its status was here.
        probe: s that decoding the same frames took this process: how fast the machine was.
        visible: frames with the target visible and answered.
        right: those of them whose box has its centre in the target's. (Strides change the width of
            a walker's true box by half: overlap would say little.)
        silence: the longest time between two statuses, s.
    """

    sent: int = 0
    boxes: int = 0
    states: Counter[str] = field(default_factory=Counter)
    own: list[float] = field(default_factory=list)
    trips: list[float] = field(default_factory=list)
    probe: list[float] = field(default_factory=list)
    visible: int = 0
    right: int = 0
    silence: float = 0.0


class SoakCamera(Node):
    """Publishes a loop of shots and takes the answers.

    A box is sent with the first frame of each round, and at random moments in between, most on
    the frame that is sent with it, some on one of half a second ago.

    Args:
        shots: the loop; a track can be started on the first.
        rate: frames/s.
        rng: of the moments of boxes.
        box_every: mean time between two boxes within a round, s.
        tracker: name of the tracker's node.
    """

    def __init__(
        self,
        shots: list[Shot],
        rate: float,
        rng: np.random.Generator,
        box_every: float = 10.0,
        tracker: str = "tracker",
    ) -> None:
        super().__init__("soak_camera")
        self._shots, self.rate, self._rng = shots, rate, rng
        self.tracker = tracker
        self._chance = 1 / (box_every * rate)
        self._late = round(rate / 2)
        self._images = self.create_publisher(Image, "image", QOS)
        self._boxes = self.create_publisher(PolygonStamped, f"{tracker}/init_box", 10)
        # Of what is ready at once the first is served first: a frame's box before its status.
        self._inputs = [
            self.create_subscription(PolygonStamped, f"{tracker}/box", self._on_box, 100),
            self.create_subscription(DiagnosticArray, f"{tracker}/status", self._on_status, 100),
            self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 10),
        ]
        self._sent: dict[int, tuple[int, float]] = {}  # stamp: number of the frame, time
        self._found: dict[int, Box] = {}
        self._heard = time.monotonic()
        self.number = 0
        self.counts: dict[str, int] = {}
        self.stretch = Stretch()

    def connected(self) -> bool:
        """Whether the camera has found the tracker; see ``handshake`` for the other direction."""
        return all(self.count_publishers(s.topic_name) > 0 for s in self._inputs) and all(
            publisher.get_subscription_count() > 0 for publisher in (self._images, self._boxes)
        )

    def begin(self) -> None:
        """Count from now on."""
        self._heard = time.monotonic()
        self.stretch = Stretch()

    def publish(self) -> None:
        """Send the next frame, and a box when it is time for one."""
        begun = time.perf_counter()
        shot = self._shots[self.number % len(self._shots)]
        image = shot.pixels()
        self.stretch.probe.append(time.perf_counter() - begun)
        stamp = self._stamp(self.number)
        message = debug_message(image, header_of(stamp, "camera"))
        self._sent[stamp] = self.number, time.monotonic()
        self._images.publish(message)
        self.stretch.sent += 1
        if self.number % len(self._shots) == 0:
            self._start(self.number)
        elif self._rng.random() < self._chance:
            self._start(self.number - self._late * int(self._rng.random() < 0.3))
        self.number += 1
        while len(self._sent) > KEPT:
            old = next(iter(self._sent))
            del self._sent[old]
            self._found.pop(old, None)

    def take_stretch(self) -> Stretch:
        """What came since the last call."""
        # A stretch without any status is a silence as well.
        self.stretch.silence = max(self.stretch.silence, time.monotonic() - self._heard)
        taken, self.stretch = self.stretch, Stretch()
        return taken

    def _start(self, number: int) -> None:
        shot = self._shots[number % len(self._shots)]
        if number >= 0 and shot.startable and shot.box is not None:
            header = header_of(self._stamp(number), "camera")
            self._boxes.publish(polygon_from_box(shot.box, header))
            self.stretch.boxes += 1

    def _stamp(self, number: int) -> int:
        return FIRST_STAMP + round(number * 1e9 / self.rate)

    def _on_box(self, message: PolygonStamped) -> None:
        stamp = stamp_ns(message.header)
        if stamp in self._sent:
            self._found[stamp] = box_from_polygon(message)

    def _on_status(self, message: DiagnosticArray) -> None:
        now, stamp = time.monotonic(), stamp_ns(message.header)
        self.stretch.silence = max(self.stretch.silence, now - self._heard)
        self._heard = now
        number, sent = self._sent.get(stamp, (-1, 0.0))
        if number < 0:
            return
        values = status_values(message)
        self.stretch.states[values["state"]] += 1
        self.stretch.own.append(float(values["latency_ms"]) / 1e3)
        self.stretch.trips.append(now - sent)
        shot = self._shots[number % len(self._shots)]
        if shot.box is not None and shot.visible >= SEEN:
            self.stretch.visible += 1
            found = self._found.get(stamp)
            self.stretch.right += int(found is not None and _holds(shot.box, found.centre))

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        values = status_values(message)
        self.counts = {name: int(values[name]) for name in COUNTED if name in values}


def _holds(box: Box, point: tuple[float, float]) -> bool:
    return bool(box.x <= point[0] < box.x + box.w and box.y <= point[1] < box.y + box.h)
