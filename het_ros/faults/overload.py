# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""More frames than the installed tracker can process: latency, drops, memory.

First the camera sends as fast as it goes, which tells how many frames a second the tracker can
process; then three times as many. Newest wins: a frame that is processed was taken when it was the
newest, so it is answered within two frame times of processing, and all others are counted as
dropped on /diagnostics.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray

from het_ros.bench.camera import WARM_UP, Camera, spun
from het_ros.bench.figures import percentiles, plain
from het_ros.bench.footage import Footage, middle
from het_ros.faults.process import Sample, look
from het_ros.ros.diagnostics import COUNTED
from het_ros.ros.status import status_values
from het_ros.tools.arguments import add_parameters, command
from het_ros.tools.handshake import Spin, meet
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.tracker_arguments import parameter_arguments
from het_ros.tools.tracker_process import TrackerProcess, find_tracker, own_graph
from het_ros.tools.transport import use_profile

TIMES = 3.0  # of what the tracker can process
LOOKS = 5
FASTEST = 600.0  # frames/s to find out what the tracker can
PATIENCE = 60.0  # s, for camera and tracker to find each other
TARGET = (60, 120)  # px

EXAMPLE = """example:
  ros2 run het_ros overload --size 640x480 --seconds 20
"""


class CountingCamera(Camera):
    """A camera that also hears what the tracker counts."""

    def __init__(self, footage: Footage, rate: float) -> None:
        super().__init__(footage, rate)
        self.counts: dict[str, int] = {}
        self.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 10)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        values = status_values(message)
        self.counts = {name: int(values[name]) for name in COUNTED}

    @property
    def all_sent(self) -> int:
        """Images, with those of the warm-up."""
        return len(self._published)

    def sent_from(self, stamp: int) -> int:
        """Images from that stamp (ns) on."""
        return sum(sent >= stamp for sent in self._published)

    def send_one(self) -> None:
        """Publish one more image after the last."""
        self._publish(self.all_sent)


def overload(size: tuple[int, int], seconds: float, parameters: tuple[str, ...]) -> dict[str, Any]:
    """Measure it.

    Returns:
        ``capacity`` frames/s, ``times`` so many of it were sent, ``sent``, ``answered``,
        ``counts`` as on /diagnostics, ``latency_frames``: percentiles of the time from publishing
        a frame to its box over the time of processing one, ``memory_growth`` from the middle
        third of the run to the last.

    Raises:
        NobodyListensError, TrackerProcessError: the tracker is not heard, or ended.
    """
    footage = Footage(*size, 6)
    with _running(footage, FASTEST, parameters) as (camera, spin, pid):
        _run(camera, spin, pid, footage, seconds / 3)
        fastest = sum(stamp in camera.own for stamp in camera.sent) / _lasted(camera)
    with _running(footage, TIMES * fastest, parameters) as (camera, spin, pid):
        held = _run(camera, spin, pid, footage, seconds)
        counted = _until_counted(camera, spin)
        times = np.array([camera.boxes[s] for s in camera.sent if s in camera.boxes])
        third = max(len(held) // 3, 1)
        middle_mb, end_mb = (
            float(np.median([sample.own_mb for sample in part]))
            for part in (held[third:-third] or held, held[-third:])
        )
        return {
            "capacity": fastest,
            "times": (len(camera.sent) - 1) / _lasted(camera) / fastest,
            "sent": camera.all_sent,
            "answered": len(camera.own),
            "counts": camera.counts,
            "all_counted": counted,
            "latency": percentiles(times),
            "latency_frames": {
                f"p{part}": float(np.percentile(times, part) * fastest) for part in (50, 95, 99)
            },
            "memory_mb": [middle_mb, end_mb],
            "memory_growth": end_mb / middle_mb - 1,
            "load": held[-1].load,
        }


def _lasted(camera: Camera) -> float:
    """From the first counted frame to the last, s."""
    return max(camera.sent.values()) - min(camera.sent.values())


def _run(camera: Camera, spin: Spin, pid: int, footage: Footage, seconds: float) -> list[Sample]:
    """Let the camera run; what the tracker's process held meanwhile, LOOKS times a second."""
    held: list[Sample] = []

    def watching(left: float) -> None:
        spin(left)
        if held and time.monotonic() - held[-1].time > 1 / LOOKS:
            held.append(look(pid))

    camera.run(seconds, middle(footage, TARGET), watching, lambda: held.append(look(pid)))
    camera.finish(spin)
    return held


def _until_counted(camera: CountingCamera, spin: Spin) -> bool:
    """Whether /diagnostics accounts for every frame from the first answer on, and for no more.

    Frames that are lost at the very end leave no gap before a later one; one more frame makes
    one.
    """
    for _ in range(5):
        camera.send_one()
        end = time.monotonic() + 1.5
        while time.monotonic() < end:
            spin(0.05)
            first = camera.sent_from(min(camera.own))
            if first <= sum(camera.counts.values()) <= camera.all_sent:
                return True
    return False


@contextmanager
def _running(
    footage: Footage, rate: float, parameters: tuple[str, ...]
) -> Iterator[tuple[CountingCamera, Spin, int]]:
    """A tracker and a camera that found each other, in a domain of their own."""
    os.environ.update(own_graph())
    use_profile()  # the tracker takes it over
    given = parameter_arguments(["diagnostics_period:=0.2", *parameters])
    with (
        tempfile.TemporaryDirectory() as folder,
        TrackerProcess(
            find_tracker(), ["--ros-args", *given], Path(folder) / "tracker.log"
        ) as tracker,
        spun(lambda: CountingCamera(footage, rate)) as (camera, spin),
    ):
        stop = StopRequest()
        meet(camera, camera.tracker, camera.connected, spin, PATIENCE, stop, tracker.check)
        yield camera, spin, tracker.pid
        tracker.check()


def main(argv: list[str] | None = None) -> int:
    """Command line."""
    p = command("overload", __doc__, EXAMPLE)
    p.add_argument("--size", default="320x240", help="of the images (320x240)")
    p.add_argument("--seconds", type=float, default=10.0, help=f"after {WARM_UP:g} s more (10)")
    add_parameters(p)
    options = p.parse_args(argv)
    width, height = (int(side) for side in options.size.split("x"))
    result = overload((width, height), options.seconds, tuple(options.parameters))
    print(json.dumps(plain(result), indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
