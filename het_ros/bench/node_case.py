# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One case of the node's bench, in a process of its own: size, rate, and where the tracker is.

Prints one JSON object; ``het_ros.bench.node`` starts it and reads that.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor

from het_ros.bench.camera import WARM_UP, Camera
from het_ros.bench.figures import percentiles
from het_ros.bench.footage import Footage, middle
from het_ros.bench.process import usage
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tools.handshake import meet
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.tracker_process import TrackerProcess, find_tracker
from het_ros.tools.transport import use_profile
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

TARGET = (60, 150)  # px
PICTURES = 6  # different frames that are kept ready as messages
PATIENCE = 30.0  # s, for camera and tracker to find each other


def main(arguments: list[str] | None = None) -> int:
    """Run one case."""
    p = argparse.ArgumentParser(
        prog="node_case",
        description=__doc__,
        epilog="example: python3 -m het_ros.bench.node_case --size 640x480 --rate 30 --how two",
    )
    p.add_argument("--size", default="640x480", help="of the images (640x480)")
    p.add_argument("--rate", type=float, default=30.0, help="frames/s (30)")
    p.add_argument("--seconds", type=float, default=10.0, help="that are counted (10)")
    p.add_argument("--how", choices=("core", "one", "two", "start"), default="two", help="(two)")
    options = p.parse_args(arguments)
    width, height = map(int, options.size.split("x"))
    if options.how == "start":
        result: dict[str, Any] = start()
    else:
        footage = Footage(width, height, PICTURES)
        run = {"core": core_alone, "one": one_process, "two": two_processes}[options.how]
        result = run(footage, options.rate, options.seconds)
    print(json.dumps(result))
    return 0


def core_alone(footage: Footage, rate: float, seconds: float) -> dict[str, Any]:
    """The core on the same frames at the same rate, without any ROS: its times, s."""
    tracker = HierarchicalEnsembleTracker(TrackerConfig())
    tracker.init(footage[0], middle(footage, TARGET))
    first = round(WARM_UP * rate)
    times = []
    begun = time.perf_counter()
    for i in range(1, first + round(seconds * rate)):
        time.sleep(max(0.0, begun + i / rate - time.perf_counter()))
        started = time.perf_counter()
        tracker.update(footage[i], 1 / rate)
        if i >= first:
            times.append(time.perf_counter() - started)
    return {"times": times}


def one_process(footage: Footage, rate: float, seconds: float) -> dict[str, Any]:
    """Camera and tracker as two nodes of one process and one thread."""
    use_profile()
    rclpy.init()
    executor = SingleThreadedExecutor()
    camera, tracker = Camera(footage, rate), TrackerNode()
    for node in (camera, tracker):
        executor.add_node(node)
    try:
        return _measured(camera, footage, seconds, os.getpid(), lambda: None, executor)
    finally:
        for node in (camera, tracker):
            node.destroy_node()
        rclpy.try_shutdown()


def two_processes(footage: Footage, rate: float, seconds: float) -> dict[str, Any]:
    """The camera here and the installed tracker in a process of its own."""
    use_profile()
    rclpy.init()
    executor = SingleThreadedExecutor()
    camera = Camera(footage, rate)
    executor.add_node(camera)
    try:
        with (
            tempfile.TemporaryDirectory() as folder,
            TrackerProcess(find_tracker(), [], Path(folder) / "tracker.log") as tracker,
        ):
            return _measured(camera, footage, seconds, tracker.pid, tracker.check, executor)
    finally:
        camera.destroy_node()
        rclpy.try_shutdown()


def start(repetitions: int = 3) -> dict[str, Any]:
    """From starting the installed tracker until a camera that waits for it is connected."""
    use_profile()
    rclpy.init()
    executor = SingleThreadedExecutor()
    camera = Camera(Footage(64, 48, 1), 30.0)
    executor.add_node(camera)
    seconds, memory = [], []
    for _ in range(repetitions):
        _wait(executor, lambda: not camera.connected())
        with tempfile.TemporaryDirectory() as folder:
            begun = time.perf_counter()
            with TrackerProcess(find_tracker(), [], Path(folder) / "tracker.log") as tracker:
                _wait(executor, camera.connected, tracker.check)
                seconds.append(time.perf_counter() - begun)
                memory.append(usage(tracker.pid).rss_mb)
    camera.destroy_node()
    rclpy.try_shutdown()
    return {"seconds": statistics.median(seconds), "rss_mb": statistics.median(memory)}


def _measured(
    camera: Camera,
    footage: Footage,
    seconds: float,
    pid: int,
    check: Callable[[], None],
    executor: SingleThreadedExecutor,
) -> dict[str, Any]:
    """Latencies, drops and what process ``pid`` takes, while the camera runs."""

    def spin(left: float) -> None:
        executor.spin_once(timeout_sec=left)

    meet(camera, camera.tracker, camera.connected, spin, PATIENCE, StopRequest(), check)
    before: list[tuple[float, float]] = []
    camera.run(
        seconds,
        middle(footage, TARGET),
        spin,
        lambda: before.append((time.perf_counter(), usage(pid).cpu)),
    )
    wall, used = time.perf_counter() - before[0][0], usage(pid)
    camera.finish(spin)
    check()
    sent = camera.sent
    return {
        "sent": len(sent),
        "rate": len(sent) / wall,
        "dropped": sum(stamp not in camera.own for stamp in sent),
        "without_box": sum(stamp not in camera.boxes for stamp in sent),
        "not_tracking": sum(camera.states.get(stamp, "TRACKING") != "TRACKING" for stamp in sent),
        "latency": percentiles([camera.boxes[s] for s in sent if s in camera.boxes]),
        "own": percentiles([camera.own[s] for s in sent if s in camera.own]),
        "cpu_share": (used.cpu - before[0][1]) / wall,
        "rss_mb": used.rss_mb,
        "peak_mb": used.peak_mb,
        "threads": used.threads,
    }


def _wait(
    executor: SingleThreadedExecutor,
    done: Callable[[], bool],
    check: Callable[[], None] = lambda: None,
) -> None:
    """Spin until ``done``.

    Raises:
        TimeoutError: it took longer than ``PATIENCE``.
    """
    end = time.perf_counter() + PATIENCE
    while not done():
        check()
        if time.perf_counter() > end:
            raise TimeoutError(f"camera and tracker did not find each other in {PATIENCE:g} s")
        executor.spin_once(timeout_sec=0.005)


if __name__ == "__main__":
    sys.exit(main())
