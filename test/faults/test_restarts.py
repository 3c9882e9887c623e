# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The camera's or the tracker's process dies and comes back; signals at any moment."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from graph import EXECUTABLES
from ros.streams import Camera, box_message, image_message

from het_ros.faults.disturb import SECOND, steady
from het_ros.ros.messages import stamp_ns
from het_ros.ros.status import status_values
from het_ros.tools.bag_reader import BagError, BagReader
from het_ros.tools.bag_repair import is_whole
from het_ros.tools.outputs import OUTPUT_TYPES

from .lockstep import crossing, header, pixels_of

RATE = 30.0
FIRST = 1000  # s
COMPRESSED = ("--ros-args", "-p", "image_transport:=compressed")
# Told when the camera is found, and where a slow machine gives the test time to miss a depth.
ANY_TIME = ("is asked for best_effort", "is subscribed to, but nothing comes on")
SANE = {0, -signal.SIGTERM, -signal.SIGINT}


def is_sane(code: int, said: str) -> bool:
    """0, the signal's, or 1 where Ctrl-C met Python before it knew its site-packages."""
    return code in SANE or (code == 1 and "init_import_site" in said)


class Watcher(Camera):
    """Hears the tracker and sends boxes; the images come from another process."""

    def __init__(self, truth, **options) -> None:
        super().__init__(compressed=True, **options)
        self.truth = truth

    def newest(self) -> int:
        return stamp_ns(self.got["status"][-1].header) if self.got["status"] else -1

    def states(self) -> list[str]:
        return [status_values(status)["state"] for status in self.got["status"]]

    def answers(self) -> list:
        """The statuses that answer images."""
        said = self.got["status"]
        return [status for status in said if float(status_values(status)["latency_ms"]) > 0]

    def start_on_newest(self) -> None:
        frame = round((self.newest() / SECOND - self.first) * RATE) % len(self.truth)
        self.boxes.publish(box_message(self.truth[frame].as_tuple(), header(self.newest())))


@pytest.fixture
def camera_process(crossing_bag):
    """``camera_process(first_stamp)`` plays the crossing round and round in another process."""
    started = []

    def start(first_stamp: float, *more: str) -> subprocess.Popen:
        words = ["--rate", str(RATE), "--rounds", "1000", "--first-stamp", str(first_stamp)]
        module = [sys.executable, "-m", "het_ros.faults.camera", str(crossing_bag)]
        started.append(subprocess.Popen([*module, *words, "--wait", "60", *more]))
        return started[-1]

    yield start
    for process in started:
        process.kill()
        process.wait()


def follow(graph, watcher: Watcher, first: float) -> None:
    """Let the tracker follow what the camera shows, from its stamp ``first`` s on."""
    watcher.first = first
    graph.spin_until(lambda: watcher.newest() >= first * SECOND, "an image")
    watcher.start_on_newest()
    graph.spin_until(lambda: watcher.states()[-1] == "TRACKING", "a track")


@pytest.mark.parametrize("gap", [pytest.param(0.5, marks=pytest.mark.slow), 5.0])
def test_a_camera_that_is_killed_and_comes_back(
    processes, local_graph, camera_process, sequences, gap
):
    """After a gap over max_gap the track is LOST and a box starts the next; else it goes on."""
    tracker = processes("tracker", *COMPRESSED)
    watcher = local_graph.add(Watcher(crossing(sequences).truth, context=local_graph.context))
    camera = camera_process(FIRST)
    follow(local_graph, watcher, FIRST)
    camera.send_signal(signal.SIGKILL)
    camera.wait()
    local_graph.settle(10)
    assert tracker.poll() is None
    # While the camera is away the node speaks by itself, with no latency. An image that was on
    # its way may be answered later than the settling; what comes after the gap is of later stamps.
    middle = stamp_ns(watcher.answers()[-1].header) + round(gap / 2 * SECOND)
    back = stamp_ns(watcher.answers()[-1].header) / SECOND + gap
    camera_process(back)

    def of_then(later: bool) -> list:
        return [a for a in watcher.answers() if (stamp_ns(a.header) > middle) is later]

    local_graph.spin_until(lambda: of_then(True), "images again")
    last, first = of_then(False)[-1], of_then(True)[0]
    said = status_values(first)
    if gap > 2:
        lasted = (stamp_ns(first.header) - stamp_ns(last.header)) / SECOND
        assert said["state"] == "LOST" and f"no image for {lasted:.1f} s" in said["reason"]
        assert "send a new box" in said["reason"]
    else:
        assert said["state"] in ("TRACKING", "COASTING")
    follow(local_graph, watcher, back)
    assert tracker.poll() is None
    assert "Traceback" not in tracker.log.read_text()


def test_a_tracker_that_is_killed_and_comes_back(processes, local_graph, sequences):
    """It comes back on the same topics, without a target and without a word of complaint."""
    footage = crossing(sequences)
    camera = local_graph.add(Camera(context=local_graph.context))
    seen = []
    for first in (1000, 1100):  # s
        stream = steady(10, RATE, first * SECOND)
        tracker = processes("tracker", "--ros-args", "-p", "image_timeout:=0.0")
        local_graph.spin_until(
            lambda log=tracker.log: "active" in log.read_text(), "the tracker's start"
        )
        camera.meet(local_graph)
        for messages in camera.got.values():
            messages.clear()
        camera.show(local_graph, image_message(pixels_of(footage, 0), header(stream[0].stamp)))
        said = status_values(camera.got["status"][-1])
        assert said["state"] == "IDLE" and said["reason"] == "waiting for a box"
        camera.boxes.publish(box_message(footage.truth[0].as_tuple(), header(stream[0].stamp)))
        local_graph.spin_until(lambda: camera.got["box"], "the first box")
        for delivery in stream[1:]:
            pixels = pixels_of(footage, delivery.frame)
            camera.show(local_graph, image_message(pixels, header(delivery.stamp)))
        assert status_values(camera.got["status"][-1])["state"] == "TRACKING"
        lines = tracker.log.read_text().splitlines()
        begin, started = (line for line in lines if not any(said in line for said in ANY_TIME))
        assert "active: images from /image, boxes on /tracker/init_box" in begin
        assert "tracking started on" in started
        names = (name for name, _ in camera.get_topic_names_and_types())
        seen.append({name for name in names if "tracker" in name})
        tracker.send_signal(signal.SIGKILL)
        tracker.wait()
    assert seen[0] == seen[1]
    assert {f"/tracker/{name}" for name in (*OUTPUT_TYPES, "init_box", "init_roi")} <= seen[0]


# Signals ----------------------------------------------------------------------------------


def processes_of_session(session: int) -> list[int]:
    """Every process that is left of a session, zombies included."""
    left = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        if int(fields[3]) == session:
            left.append(int(stat.parent.name))
    return left


def interrupt(command: list[str], after: float, number: int, again: float | None, log) -> int:
    """Start, signal after so many s, and perhaps once more; the exit code.

    Nothing may be left of it, and it has all the time it wants to end.
    """
    with log.open("w") as output:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    try:
        time.sleep(after)
        process.send_signal(number)
        if again is not None:
            time.sleep(again)
            process.send_signal(number)
        code = process.wait(60)
        assert processes_of_session(process.pid) == []
        return code
    finally:
        process.kill()
        process.wait()


def moments(count: int, longest: float, seed: int):
    """Random moments, signals, and seconds until the same signal comes once more, or None."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        number = signal.SIGTERM if rng.random() < 0.5 else signal.SIGINT
        again = float(rng.uniform(0, 0.1)) if rng.random() < 0.3 else None
        yield float(rng.uniform(0, longest)), number, again


def hammer_tracker(count: int, seed: int, log) -> list[int]:
    codes = []
    for after, number, again in moments(count, 2.5, seed):
        tracker = [str(EXECUTABLES / "tracker"), *COMPRESSED]
        codes.append(interrupt(tracker, after, number, again, log))
        said = log.read_text()
        assert is_sane(codes[-1], said), (codes[-1], said)
        # Before rclpy listens, Ctrl-C meets Python while it imports, which says so.
        if codes[-1] == 0:
            assert "Traceback" not in said, said
    return codes


def test_signals_at_any_moment_end_the_tracker(processes, camera_process, tmp_path):
    """Starting, waiting, tracking, ending: images and boxes come all the time."""
    camera_process(FIRST, "--boxes", "/tracker/init_box")
    hammer_tracker(6, 1, tmp_path / "log.txt")


@pytest.mark.slow
def test_many_signals_at_any_moment_end_the_tracker(processes, camera_process, tmp_path):
    camera_process(FIRST, "--boxes", "/tracker/init_box")
    codes = hammer_tracker(100, 2, tmp_path / "log.txt")
    print({code: codes.count(code) for code in set(codes)})
    assert codes.count(0) > 20


def bag_is_sound(path: Path) -> bool:
    """No bag at all, or one that can be read to its end."""
    if not path.exists():
        return True
    files = list(path.glob("*.mcap"))
    if not files or files[0].stat().st_size == 0:
        return not (path / "metadata.yaml").exists()
    assert is_whole(files[0]), f"{path} was cut off"
    try:
        with BagReader(path) as bag:
            return sum(1 for _ in bag.recorded()) == sum(bag.counts.values())
    except BagError:
        return False


TOOLS = {
    "make_bag": (lambda bag, sequence, out: [str(sequence), str(out)], 2.0, ""),
    "replay": (lambda bag, sequence, out: [str(bag), "--out", str(out)], 5.0, "bag"),
    "run": (lambda bag, sequence, out: ["--bag", str(bag), "--out", str(out)], 9.0, "bag"),
}


def hammer_tool(tool: str, count: int, seed: int, bag, sequence, folder) -> None:
    arguments, longest, inside = TOOLS[tool]
    for number, (after, what, _) in enumerate(moments(count, longest, seed)):
        out = folder / f"out{number}"
        command = [sys.executable, "-m", f"het_ros.tools.{tool}", *arguments(bag, sequence, out)]
        log = folder / "log.txt"
        trackers = running_trackers()
        code = interrupt(command, after, what, None, log)
        assert code == 130 or is_sane(code, log.read_text()), (code, log.read_text())
        assert bag_is_sound(out / inside), (number, log.read_text())
        assert running_trackers() <= trackers


def running_trackers() -> set[int]:
    """Trackers of this test's own domain."""
    mine = f"ROS_DOMAIN_ID={os.environ.get('ROS_DOMAIN_ID')}".encode()
    found = set()
    for line in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if b"lib/het_ros/tracker" in line.read_bytes() and mine in (
                line.parent / "environ"
            ).read_bytes().split(b"\0"):
                found.add(int(line.parent.name))
        except OSError:
            continue
    return found


def test_signals_leave_no_broken_bag(crossing_bag, sequences, tmp_path):
    hammer_tool("make_bag", 3, 3, crossing_bag, sequences / "Woman", tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("tool", list(TOOLS))
def test_many_signals_leave_no_broken_bag(crossing_bag, sequences, tmp_path, tool):
    hammer_tool(tool, 20, 4, crossing_bag, sequences / "Woman", tmp_path)
