# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pull the cable between a camera's and a tracker's host, and put it back.

Two network namespaces joined by a veth pair, as in ``het_ros.tools.two_hosts``. Prints what the
camera heard before, during and after, as JSON. Needs root.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections import Counter
from contextlib import nullcontext
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from het_ros.bench.camera import QOS
from het_ros.bench.footage import Footage, middle
from het_ros.ros.debug_image import debug_message
from het_ros.ros.messages import header_of, polygon_from_box, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.arguments import command
from het_ros.tools.two_hosts import (
    namespaces,
    printed_by_camera,
    shared_graph,
    tracker_on_its_host,
)

SIZE = (160, 120)  # px: an image that fits into one UDP datagram
RATE = 30.0  # frames/s
TARGET = (30, 40)  # px
ENOUGH = 20  # statuses that show that it works
PATIENCE = 60.0  # s
MODULE = "het_ros.faults.cable"

EXAMPLE = """example:
  sudo -E python3 -m het_ros.faults.cable --seconds 5
"""


class Camera(Node):
    """Sends images all the time, and keeps the statuses."""

    def __init__(self) -> None:
        super().__init__("camera")
        self._footage = Footage(*SIZE, 6)
        self._images = self.create_publisher(Image, "image", QOS)
        self._boxes = self.create_publisher(PolygonStamped, "tracker/init_box", 10)
        self.create_subscription(DiagnosticArray, "tracker/status", self._on_status, 100)
        self._number = 0
        self._due = time.monotonic()
        self.heard: list[tuple[int, dict[str, str]]] = []

    def step(self) -> None:
        """Send the next image when it is due and serve what came."""
        rclpy.spin_once(self, timeout_sec=max(min(self._due - time.monotonic(), 0.02), 0.0))
        if time.monotonic() >= self._due:
            header = header_of(time.time_ns(), "camera")
            self._images.publish(debug_message(self._footage[self._number], header))
            self._number += 1
            self._due += 1 / RATE

    def send_box(self) -> None:
        """Send a box for the newest image, stamp 0."""
        self._boxes.publish(polygon_from_box(middle(self._footage, TARGET), Header()))

    def _on_status(self, message: DiagnosticArray) -> None:
        self.heard.append((stamp_ns(message.header), status_values(message)))

    def run_until(self, done: Any, what: str) -> None:
        """Go on until ``done()``; TimeoutError where that does not come."""
        end = time.monotonic() + PATIENCE
        while not done():
            self.step()
            if time.monotonic() > end:
                raise TimeoutError(f"{what} did not come within {PATIENCE:g} s")

    def track(self) -> Counter[str]:
        """Send boxes until it tracks, and go on for ENOUGH statuses; their states."""
        self._asked = 0.0

        def tracking() -> bool:
            if time.monotonic() - self._asked > 1:
                self._asked = time.monotonic()
                self.send_box()
            return bool(self.heard) and self.heard[-1][1]["state"] == "TRACKING"

        self.run_until(tracking, "a track")
        first = len(self.heard)
        self.run_until(lambda: len(self.heard) >= first + ENOUGH, "statuses")
        return Counter(values["state"] for _, values in self.heard[first:])


def pull(seconds: float) -> dict[str, Any]:
    """What the camera heard before, while the cable was out for so long, and after."""
    camera = Camera()
    camera.run_until(lambda: camera.heard, "the tracker")
    before = camera.track()
    _cable("down")
    for _ in range(3):  # what is on its way
        camera.step()
    cut, heard = time.time_ns(), len(camera.heard)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        camera.step()
    mended = time.time_ns()
    while_cut = sum(cut < stamp < mended for stamp, _ in camera.heard[heard:])
    _cable("up")
    camera.run_until(
        lambda: any(stamp > mended for stamp, _ in camera.heard), "a status after the cut"
    )
    first = next(values for stamp, values in camera.heard if stamp > mended)
    return {
        "before": before,
        "answered_while_cut": while_cut,
        "silent_s": time.time_ns() / 1e9 - cut / 1e9,
        "first_after": first,
        "after_a_box": camera.track(),
    }


def _cable(way: str) -> None:
    subprocess.run(["ip", "-n", "het_tracker", "link", "set", "het_tracker", way], check=True)


def main(argv: list[str] | None = None) -> int:
    """Command line."""
    p = command("cable", __doc__, EXAMPLE)
    p.add_argument("--seconds", type=float, default=5.0, help="the cable is out (5)")
    p.add_argument("--inside", action="store_true", help="the namespaces are there already")
    p.add_argument("--camera", action="store_true", help=argparse.SUPPRESS)
    options = p.parse_args(argv)
    if options.camera:
        rclpy.init()
        print(json.dumps(pull(options.seconds)))
        rclpy.shutdown()
        return 0
    if os.geteuid() != 0:
        print("cable: needs root, for the network namespaces: sudo -E", file=sys.stderr)
        return 2
    with nullcontext() if options.inside else namespaces():
        print(json.dumps(_both(options.seconds), indent=1))
    return 0


def _both(seconds: float) -> dict[str, Any]:
    """Tracker and camera, each on its host."""
    environment = shared_graph()
    with tracker_on_its_host(environment) as tracker:
        told = printed_by_camera(environment, MODULE, "--camera", "--seconds", str(seconds))
        return {**told, "tracker_alive": tracker.poll() is None}


if __name__ == "__main__":
    sys.exit(main())
