# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Camera and tracker on two hosts, made of two network namespaces: rate and latency of answers.

``sudo -E ros2 run het_ros two_hosts`` runs the installed tracker in one namespace and a
camera in the other, joined by a veth pair, once for each setting, and prints a Markdown table.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from het_ros.ros.debug_image import debug_message
from het_ros.ros.messages import header_of, polygon_from_box, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.handshake import meet
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.tracker_process import find_tracker
from het_ros.tracking.box import Box

HOSTS = {"het_camera": "10.77.0.1/24", "het_tracker": "10.77.0.2/24"}
RATE = 30.0  # frames/s
PATIENCE = 20.0  # s, for discovery
DOMAIN = "77"
MODULE = "het_ros.tools.two_hosts"


@dataclass(frozen=True)
class Setting:
    """One row of the table.

    Attributes:
        name: its words in the table.
        reliable: both sides ask for reliable images, else best effort.
        large_data: FASTDDS_BUILTIN_TRANSPORTS=LARGE_DATA on both sides.
    """

    name: str
    reliable: bool
    large_data: bool


SETTINGS = (
    Setting("best effort", reliable=False, large_data=False),
    Setting("reliable", reliable=True, large_data=False),
    Setting("best effort, LARGE_DATA", reliable=False, large_data=True),
    Setting("reliable, LARGE_DATA", reliable=True, large_data=True),
)


class Camera(Node):
    """Sends a moving texture and takes the statuses, each with the time it took."""

    def __init__(self, reliable: bool) -> None:
        super().__init__("camera")
        kind = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
        self._images = self.create_publisher(Image, "image", QoSProfile(depth=1, reliability=kind))
        self._boxes = self.create_publisher(PolygonStamped, "tracker/init_box", 10)
        self.create_subscription(DiagnosticArray, "tracker/status", self._on_status, 50)
        self._sent: dict[int, float] = {}
        self.answers: dict[int, float] = {}
        self.own: list[float] = []

    def connected(self) -> bool:
        """Whether the camera has found the tracker; see ``handshake`` for the other direction."""
        publishers = (self._images, self._boxes)
        return self.count_publishers("tracker/status") > 0 and all(
            publisher.get_subscription_count() > 0 for publisher in publishers
        )

    def run(self, width: int, height: int, frames: int) -> None:
        """Send at RATE, and take answers for a second and a half more."""
        rng = np.random.default_rng(0)
        blocks = rng.integers(0, 255, (height // 16, width // 16, 3), np.uint8)
        texture = cv2.resize(blocks, (width, height))
        start = time.monotonic()
        for i in range(frames):
            header = header_of(round((1 + i / RATE) * 1e9), "camera")
            image = debug_message(np.roll(texture, 2 * i, axis=1), header)
            self._sent[stamp_ns(header)] = time.monotonic()
            self._images.publish(image)
            if i == 0:
                self._boxes.publish(polygon_from_box(Box(100, 100, 40, 80), Header()))
            self._spin_until(start + (i + 1) / RATE)
        self._spin_until(time.monotonic() + 1.5)

    def _spin_until(self, end: float) -> None:
        while time.monotonic() < end:
            rclpy.spin_once(self, timeout_sec=0.002)

    def _on_status(self, message: DiagnosticArray) -> None:
        stamp = stamp_ns(message.header)
        if stamp in self._sent and stamp not in self.answers:
            self.answers[stamp] = time.monotonic() - self._sent[stamp]
            self.own.append(float(status_values(message)["latency_ms"]))


def send(reliable: bool, width: int, height: int, frames: int) -> dict[str, float]:
    """What the camera's process does: send, and sum up the answers."""
    rclpy.init()
    camera = Camera(reliable)
    meet(
        camera,
        "tracker",
        camera.connected,
        lambda seconds: rclpy.spin_once(camera, timeout_sec=seconds),
        PATIENCE,
        StopRequest(),
    )
    camera.run(width, height, frames)
    rclpy.shutdown()
    times = 1e3 * np.array(list(camera.answers.values()) or [np.nan])
    return {
        "answered": len(camera.answers) / frames,
        "p50": float(np.percentile(times, 50)),
        "p95": float(np.percentile(times, 95)),
        "own": float(np.median(camera.own or [np.nan])),
    }


@contextmanager
def namespaces() -> Iterator[None]:
    """The two hosts and the cable between them, taken away at the end."""
    _ip("link", "add", "het_camera", "type", "veth", "peer", "name", "het_tracker")
    try:
        for host, address in HOSTS.items():
            _ip("netns", "add", host)
            _ip("link", "set", host, "netns", host)
            _ip("-n", host, "addr", "add", address, "dev", host)
            _ip("-n", host, "link", "set", host, "up")
            _ip("-n", host, "link", "set", "lo", "up")
        yield
    finally:
        for host in HOSTS:
            subprocess.run(["ip", "netns", "del", host], check=False, stderr=subprocess.DEVNULL)


def shared_graph() -> dict[str, str]:
    """Environment of processes that find each other over the cable, with Fast DDS's defaults."""
    environment = dict(os.environ, ROS_DOMAIN_ID=DOMAIN, ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET")
    environment.pop("FASTRTPS_DEFAULT_PROFILES_FILE", None)
    return environment


@contextmanager
def tracker_on_its_host(
    environment: dict[str, str], *arguments: str
) -> Iterator[subprocess.Popen[bytes]]:
    """The installed tracker with these ROS arguments on its host; ended with the block."""
    command = [*_on("het_tracker"), str(find_tracker()), "--ros-args", *arguments]
    tracker = subprocess.Popen([*command, "--log-level", "error"], env=environment)
    try:
        yield tracker
    finally:
        tracker.send_signal(signal.SIGTERM)
        tracker.wait()


def printed_by_camera(environment: dict[str, str], module: str, *arguments: str) -> dict[str, Any]:
    """Run a module on the camera's host; the JSON object that it prints.

    Raises:
        subprocess.CalledProcessError: it failed.
    """
    command = [*_on("het_camera"), sys.executable, "-m", module, *arguments]
    done = subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE)
    return dict(json.loads(done.stdout))


def _on(host: str) -> list[str]:
    return ["ip", "netns", "exec", host]


def measure(setting: Setting, width: int, height: int, frames: int) -> dict[str, float]:
    """One row: the tracker on its host, the camera on the other."""
    environment = shared_graph()
    if setting.large_data:
        environment["FASTDDS_BUILTIN_TRANSPORTS"] = "LARGE_DATA"
    kind = "reliable" if setting.reliable else "best_effort"
    override = f"qos_overrides./image.subscription.reliability:={kind}"
    with tracker_on_its_host(environment, "-p", override):
        sizes = (f"--size={width}x{height}", f"--frames={frames}")
        return printed_by_camera(environment, MODULE, *sizes, f"--send={kind}")


def main(arguments: list[str] | None = None) -> int:
    """Measure all settings at VGA and 720p, or what ``--size`` says."""
    parser = argparse.ArgumentParser(
        prog="two_hosts",
        description="Rate and latency between a camera and a tracker on two (made) hosts. "
        "Needs root and iproute2, for the network namespaces.",
        epilog="example: sudo -E ros2 run het_ros two_hosts --frames 300",
    )
    parser.add_argument("--size", default="640x480,1280x720", help="(640x480,1280x720)")
    parser.add_argument("--frames", type=int, default=150, help="of each setting (150)")
    parser.add_argument("--send", choices=("reliable", "best_effort"), help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    sizes = [tuple(map(int, size.split("x"))) for size in options.size.split(",")]
    if options.send:
        print(json.dumps(send(options.send == "reliable", *sizes[0], options.frames)))
        return 0
    if os.geteuid() != 0:
        print("two_hosts: needs root, for the network namespaces: sudo -E", file=sys.stderr)
        return 2
    print("| images | setting | answered | round trip p50 | p95 | node's own p50 |")
    print("|---|---|---|---|---|---|", flush=True)
    with namespaces():
        for width, height in sizes:
            for setting in SETTINGS:
                row = measure(setting, width, height, options.frames)
                print(
                    f"| {width}x{height} | {setting.name} | {row['answered']:.0%} | "
                    f"{row['p50']:.1f} ms | {row['p95']:.1f} ms | {row['own']:.1f} ms |",
                    flush=True,
                )
    return 0


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


if __name__ == "__main__":
    sys.exit(main())
