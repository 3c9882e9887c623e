# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import av
import pytest

from het_ros.tools.bag_reader import BagReader
from het_ros.tools.results import read_csv
from het_ros.tools.run import main
from het_ros.tools.tracker_process import (
    TrackerProcess,
    TrackerProcessError,
    find_tracker,
    free_domain,
)

ROOT = Path(__file__).parents[2]
PATIENCE = 120  # s: how long something that must happen may take on a busy machine


@pytest.fixture
def executable(monkeypatch, tmp_path) -> Path:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    try:
        return find_tracker()
    except TrackerProcessError as error:
        pytest.skip(str(error))


@pytest.fixture
def sequence_folder(crossing, tmp_path) -> Path:
    """24 real frames in OTB's layout."""
    (tmp_path / "sequence" / "img").mkdir(parents=True)
    for file in crossing.images[:24]:
        (tmp_path / "sequence" / "img" / file.name).symlink_to(file)
    boxes = [f"{box.x + 1},{box.y + 1},{box.w},{box.h}\n" for box in crossing.truth[:24]]
    (tmp_path / "sequence" / "groundtruth_rect.txt").write_text("".join(boxes))
    return tmp_path / "sequence"


def frames_of(video: Path) -> int:
    with av.open(str(video)) as container:
        return sum(1 for _ in container.decode(video=0))


def test_the_installed_tracker_answers_what_it_is_sent(
    executable, sequence_folder, tmp_path, capfd
):
    """Process to process over DDS; a busy machine may lose some, as the newest image wins."""
    out = tmp_path / "out"
    assert main(["--sequence", str(sequence_folder), "--out", str(out), "--fps", "4"]) == 0
    rows = read_csv(out / "track.csv")
    answered = [row for row in rows if row.state]
    assert len(rows) == 24
    assert len(answered) >= 0.5 * len(rows), (out / "tracker.log").read_text()
    printed = capfd.readouterr().out
    assert f"24 sent, {len(answered)} answered" in printed
    assert "mean IoU" in printed
    assert "is subscribed to, but nothing comes" not in printed  # of what the footage lacks
    assert str(out / "track.mp4") in printed
    with BagReader(out / "bag") as bag:
        stamps = {recorded.time for recorded in bag.recorded("/tracker/status")}
    assert stamps == {row.stamp for row in answered}
    assert frames_of(out / "track.mp4") == 24
    assert (out / "track.png").stat().st_size > 50_000


def children_of(pid: int) -> list[int]:
    return [int(c) for c in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def wait_until(happened, what: str) -> None:
    end = time.monotonic() + PATIENCE
    while not happened():
        assert time.monotonic() < end, f"did not happen: {what}"
        time.sleep(0.02)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_in_the_middle_leaves_readable_results_and_no_process(
    executable, crossing_bag, tmp_path, number
):
    out, log = tmp_path / "out", tmp_path / "err.txt"
    command = [sys.executable, "-m", "het_ros.tools.run", "--bag", str(crossing_bag)]
    with log.open("wb") as errors:
        process = subprocess.Popen(
            [*command, "--out", str(out), "--rate", "0.02"],
            cwd=ROOT,
            stdout=subprocess.DEVNULL,
            stderr=errors,
            env=os.environ | {"PYTHONUNBUFFERED": "1"},
            # A shell's background job ignores SIGINT, and a child inherits that.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
    try:
        started = out / "tracker.log"
        wait_until(
            lambda: started.exists() and "tracking started" in started.read_text(),
            "the tracker starts on the first frame",
        )
        (tracker,) = children_of(process.pid)
        process.send_signal(number)
        assert process.wait(PATIENCE) == 130, log.read_text()
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
    assert not Path(f"/proc/{tracker}").exists()
    rows = read_csv(out / "track.csv")
    assert 1 <= len(rows) < 40
    assert frames_of(out / "track.mp4") == len(rows)
    with BagReader(out / "bag") as bag:
        assert bag.counts["/tracker/status"] >= 1
    assert (out / "track.png").exists()


def test_a_tracker_that_ends_by_itself_is_reported_with_its_words(crossing_bag, tmp_path, capsys):
    broken = tmp_path / "tracker"
    broken.write_text("#!/bin/sh\necho cannot go on\nexit 3\n")
    broken.chmod(0o755)
    options = ["--bag", str(crossing_bag), "--out", str(tmp_path / "out")]
    assert main([*options, "--tracker", str(broken)]) == 1
    told = capsys.readouterr().err
    assert "exit code 3" in told
    assert "cannot go on" in told


def test_a_tracker_that_ignores_sigterm_is_ended_all_the_same(tmp_path, monkeypatch):
    monkeypatch.setattr("het_ros.tools.tracker_process.PATIENCE", 0.1)
    stubborn = tmp_path / "tracker"
    stubborn.write_text("#!/bin/sh\ntrap '' TERM\necho ready\nwhile :; do sleep 0.05; done\n")
    stubborn.chmod(0o755)
    log = tmp_path / "log.txt"
    with TrackerProcess(stubborn, [], log) as process:
        wait_until(lambda: "ready" in log.read_text(), "the script starts")
        process.check()
    assert not Path(f"/proc/{process.pid}").exists()


def test_a_video_without_a_box_is_refused(tmp_path, capsys):
    with pytest.raises(SystemExit):
        main(["--video", "some.mp4", "--out", str(tmp_path)])
    assert "--video needs --init" in capsys.readouterr().err


def test_no_bag_is_told(tmp_path, capsys):
    options = ["--bag", str(tmp_path / "none"), "--out", str(tmp_path / "out")]
    assert main([*options, "--tracker", "tracker"]) == 1
    assert "no rosbag2" in capsys.readouterr().err


def test_a_domain_in_use_is_left_alone(monkeypatch):
    import socket

    domain = free_domain()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("", 7400 + 250 * domain + 10))
        assert free_domain() != domain
    assert 1 <= domain < 100


@pytest.mark.parametrize("tool", ["make_bag", "play", "replay", "run"])
def test_every_command_shows_an_example(tool):
    command = [sys.executable, "-m", f"het_ros.tools.{tool}", "--help"]
    shown = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    assert f"ros2 run het_ros {tool}" in shown.split("example", 1)[1]
