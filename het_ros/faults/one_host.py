# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Camera and tracker as two processes of one host: images that are lost, places that come.

``--what images`` sends raw images, reliable or best effort, with and without the shipped profile
of Fast DDS, and counts the answers. ``--what depth`` sends depth before and after its images, and
counts the TRACKING frames of which ``~/target_pose`` comes. Both print a Markdown table.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped, PoseStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Header
from tqdm import tqdm

from het_ros.bench.footage import Footage, middle
from het_ros.ros.debug_image import debug_message
from het_ros.ros.messages import header_of, polygon_from_box, stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.arguments import command
from het_ros.tools.handshake import meet
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.tracker_process import TrackerProcess, find_tracker, own_graph
from het_ros.tools.transport import SETTINGS, use_profile

SIZE = (640, 480)  # px
TARGET = (60, 120)  # px
PICTURES = 6  # different frames that are kept ready as messages
WARM_UP = 1.0  # s, that are not counted: what is offered is found out
GRACE = 1.0  # s, for answers that are on their way
PATIENCE = 60.0  # s, for camera and tracker to find each other
METRES = 3.0
MODULE = "het_ros.faults.one_host"

EXAMPLE = """examples:
  ros2 run het_ros one_host --what images --seconds 7
  ros2 run het_ros one_host --what depth
"""


@dataclass(frozen=True)
class Case:
    """What is sent.

    Attributes:
        rate: frames/s.
        seconds: that are counted.
        reliable: whether the images are offered reliable, else best effort.
        profile: whether the camera runs with the shipped profile of Fast DDS.
        depth: whether depth is sent.
        lag: (least, most) s that depth comes after its image; negative is before.
        asked: the tracker's parameter ``reliability``.
    """

    rate: float = 30.0
    seconds: float = 7.0
    reliable: bool = True
    profile: bool = True
    depth: bool = False
    lag: tuple[float, float] = (0.0, 0.0)
    asked: str = "auto"


@dataclass(frozen=True)
class Count:
    """What came of it, in frames that count."""

    sent: int
    answered: int
    tracking: int
    placed: int
    latency_p50_ms: float


class Camera(Node):
    """Sends images and depth, and takes the answers."""

    def __init__(self, case: Case) -> None:
        super().__init__("camera")
        kind = ReliabilityPolicy.RELIABLE if case.reliable else ReliabilityPolicy.BEST_EFFORT
        qos = QoSProfile(depth=1, reliability=kind)
        self._case = case
        self._footage = Footage(*SIZE, PICTURES)
        self._pictures = [debug_message(self._footage[i], Header()) for i in range(PICTURES)]
        self._images = self.create_publisher(Image, "image", qos)
        self._depth = self.create_publisher(Image, "depth", qos) if case.depth else None
        self._info = self.create_publisher(CameraInfo, "camera_info", 10)
        self._boxes = self.create_publisher(PolygonStamped, "tracker/init_box", 10)
        self.create_subscription(DiagnosticArray, "tracker/status", self._on_status, 50)
        self.create_subscription(PoseStamped, "tracker/target_pose", self._on_place, 50)
        self._sent: dict[int, float] = {}
        self._states: dict[int, tuple[str, float]] = {}
        self._placed: set[int] = set()

    def connected(self) -> bool:
        """Whether the camera has found the tracker."""
        publishers = [self._images, self._boxes, *([self._depth] if self._depth else [])]
        return self.count_publishers("tracker/status") > 0 and all(
            publisher.get_subscription_count() > 0 for publisher in publishers
        )

    def run(self, spin: Callable[[float], None]) -> Count:
        """Send all that is due, then count."""
        start = time.monotonic()
        for due, frame, is_depth in self._timeline():
            while (left := start + due - time.monotonic()) > 0:
                spin(left)
            if is_depth:
                self._send_depth(frame)
            else:
                self._send_image(frame)
        end = time.monotonic() + GRACE
        while time.monotonic() < end:
            spin(0.02)
        return self._count()

    def _timeline(self) -> list[tuple[float, int, bool]]:
        """When each image and depth image is due, s from the start, in order."""
        case, drawn = self._case, random.Random(0)
        events = []
        for frame in range(round((WARM_UP + case.seconds) * case.rate)):
            due = 0.2 + frame / case.rate
            events.append((due, frame, False))
            if case.depth:
                events.append((due + drawn.uniform(*case.lag), frame, True))
        return sorted(events)

    def _send_image(self, frame: int) -> None:
        message = self._pictures[self._footage.at(frame)]
        message.header = self._header(frame)
        self._info.publish(self._camera_info(message.header))
        self._sent[stamp_ns(message.header)] = time.monotonic()
        self._images.publish(message)
        if frame == 0:
            self._boxes.publish(polygon_from_box(middle(self._footage, TARGET), Header()))

    def _send_depth(self, frame: int) -> None:
        width, height = SIZE
        millimetres = np.full((height, width), 1000 * METRES, np.uint16)
        self._depth.publish(
            Image(
                header=self._header(frame), width=width, height=height, encoding="16UC1",
                step=2 * width, data=millimetres.tobytes(),
            )
        )  # fmt: skip

    def _header(self, frame: int) -> Header:
        return header_of(round((1000 + frame / self._case.rate) * 1e9), "camera")

    def _camera_info(self, header: Header) -> CameraInfo:
        width, height = SIZE
        matrix = [500.0, 0.0, width / 2, 0.0, 500.0, height / 2, 0.0, 0.0, 1.0]
        return CameraInfo(header=header, width=width, height=height, k=matrix)

    def _on_status(self, message: DiagnosticArray) -> None:
        stamp = stamp_ns(message.header)
        if stamp in self._sent:
            latency = time.monotonic() - self._sent[stamp]
            self._states[stamp] = status_values(message)["state"], latency

    def _on_place(self, message: PoseStamped) -> None:
        self._placed.add(stamp_ns(message.header))

    def _count(self) -> Count:
        first = stamp_ns(self._header(round(WARM_UP * self._case.rate)))
        sent = [stamp for stamp in self._sent if stamp >= first]
        answered = [stamp for stamp in sent if stamp in self._states]
        tracking = [stamp for stamp in answered if self._states[stamp][0] == "TRACKING"]
        latencies = [self._states[stamp][1] for stamp in answered] or [float("nan")]
        return Count(
            len(sent),
            len(answered),
            len(tracking),
            sum(stamp in self._placed for stamp in tracking),
            1e3 * float(np.median(latencies)),
        )


def run(case: Case) -> Count:
    """The camera in this process, the installed tracker in another."""
    rclpy.init()
    camera, executor = Camera(case), SingleThreadedExecutor()
    executor.add_node(camera)

    def spin(seconds: float) -> None:
        executor.spin_once(timeout_sec=max(seconds, 0.0))

    try:
        with tempfile.TemporaryDirectory() as folder:
            arguments = ["--ros-args", "-p", f"reliability:={case.asked}"]
            log = Path(folder) / "tracker.log"
            with TrackerProcess(find_tracker(), arguments, log) as tracker:
                meet(
                    camera, "tracker", camera.connected, spin, PATIENCE, StopRequest(),
                    tracker.check,
                )  # fmt: skip
                return camera.run(spin)
    finally:
        camera.destroy_node()
        rclpy.try_shutdown()


def image_cases(seconds: float) -> Iterator[tuple[str, Case]]:
    """What is compared of images, with the words of its row."""
    for reliable in (True, False):
        for profile in (False, True):
            for asked in ("auto", "best_effort"):
                words = f"{'reliable' if reliable else 'best effort'} | "
                words += f"{'yes' if profile else 'no'} | {asked}"
                yield words, Case(seconds=seconds, reliable=reliable, profile=profile, asked=asked)


LAGS = {
    "20 ms early": (-0.02, -0.02),
    "20 ms late": (0.02, 0.02),
    "60 ms late": (0.06, 0.06),
    "150 ms late": (0.15, 0.15),
    "30 ms early to 60 ms late": (-0.03, 0.06),
}


def depth_cases(seconds: float) -> Iterator[tuple[str, Case]]:
    """What is compared of depth, with the words of its row."""
    for rate in (5.0, 15.0, 30.0):
        for words, lag in LAGS.items():
            yield (
                f"{rate:g} | {words}",
                Case(rate=rate, seconds=max(seconds, 50 / rate), depth=True, lag=lag),
            )


def in_a_process(case: Case) -> Count:
    """Run a case in a process of its own: Fast DDS reads its profile once a process."""
    environment = {**os.environ, **own_graph()}
    for name in SETTINGS:
        environment.pop(name, None)
    arguments = [sys.executable, "-m", MODULE, "--case", json.dumps(asdict(case))]
    done = subprocess.run(arguments, env=environment, check=True, stdout=subprocess.PIPE)
    return Count(**json.loads(done.stdout))


def main(arguments: list[str] | None = None) -> int:
    """Measure and print a table."""
    parser = command("one_host", __doc__, EXAMPLE)
    parser.add_argument("--what", choices=("images", "depth"), default="images", help="(images)")
    parser.add_argument("--seconds", type=float, default=7.0, help="that count, of each row (7)")
    parser.add_argument("--case", help="(one case, for internal use)")
    options = parser.parse_args(arguments)
    if options.case:
        case = Case(**json.loads(options.case))
        if case.profile:
            use_profile()
        print(json.dumps(asdict(run(case))))
        return 0
    images = options.what == "images"
    cases = list(image_cases(options.seconds) if images else depth_cases(options.seconds))
    rows = []
    for words, case in tqdm(cases, desc=options.what, unit="case"):
        count = in_a_process(case)
        part = (count.answered, count.sent) if images else (count.placed, count.tracking)
        rows.append(
            f"| {words} | {part[0]} of {part[1]} ({part[0] / max(part[1], 1):.1%}) | "
            f"{count.latency_p50_ms:.0f} ms |"
        )
    if images:
        print("| camera offers | profile | `reliability` | answered | latency p50 |")
    else:
        print("| frames/s | depth comes | TRACKING frames with a place | latency p50 |")
    print("|---" * (5 if images else 4) + "|")
    print("\n".join(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
