# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every command of README and tutorials is run as written, or it is said why it cannot be.

They run in a folder of links to the checkout, so that nothing is written into it, with the files
of a user in it: a video and a folder of images. ``ros2 run`` is a script that does what it does:
start the executable that colcon installed.
"""

import os
import re
import subprocess

import cv2
import pytest
from moving_target import moving_target

from pages.pages import ROOT, commands, name_of

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "tutorials").glob("*.md"))]
FOUND = {command: page for page in reversed(PAGES) for command in commands(page)}

CI = "CI runs it"
SLOW = "run by `make faults`, takes minutes"
APT = "needs packages from apt"
ROBOT = "needs a robot"
FOREVER = "does not end by itself; test/operator starts the same"
# The first pattern that matches a command says why it is not run here.
NOT_RUN = {
    r"make test$": CI,
    r"make operator|ros2 run het_ros operator": FOREVER,
    r"ros2 run het_ros closed_loop": SLOW,
    r"make run VIDEO=/usr": APT,
    r"cd |rosdep |colcon |python3 -m pip |sudo apt ": APT,
    r"ros2 (topic|launch|action) |rviz2 ": APT,
    r"ros2 run het_ros (tracker|follower_example)": ROBOT,
}
RUN = [c for c in FOUND if not any(re.match(pattern, c) for pattern in NOT_RUN)]
ROS2 = f"""#!/bin/sh
test "$1 $2" = "run het_ros" && exec {ROOT}/install/het_ros/lib/het_ros/"$3"
"""
BOX = 258, 219, 33, 89  # of the target in walk.mp4, px


@pytest.fixture(scope="module")
def checkout(tmp_path_factory, installed):
    """A folder of links to the checkout, with what a user has."""
    folder = tmp_path_factory.mktemp("checkout")
    for entry in ROOT.iterdir():
        if entry.name not in ("out", ".git"):
            (folder / entry.name).symlink_to(entry)
    (folder / "bin").mkdir()
    (folder / "bin" / "ros2").write_text(ROS2)
    (folder / "bin" / "ros2").chmod(0o755)
    x, y, w, h = BOX
    frames = []
    for small in moving_target(15):
        frame = cv2.resize(small[40:120, 20:140], (640, 480))
        frame[y : y + h, x : x + w] = cv2.resize(small[40:72, 20:40], (w, h))
        frames.append(frame)
    writer = cv2.VideoWriter(
        str(folder / "walk.mp4"), cv2.VideoWriter_fourcc(*"mp4v"), 15, (640, 480)
    )
    (folder / "folder" / "img").mkdir(parents=True)
    for number, frame in enumerate(frames, 1):
        writer.write(frame)
        cv2.imwrite(str(folder / "folder" / "img" / f"{number:04}.jpg"), frame)
    writer.release()
    (folder / "folder" / "groundtruth_rect.txt").write_text("259,220,33,89\n" * len(frames))
    return folder


@pytest.mark.parametrize("command", RUN)
def test_a_command_runs_as_written(checkout, command):
    outer = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS"}
    environment = {name: value for name, value in os.environ.items() if name not in outer}
    environment["PATH"] = f"{checkout / 'bin'}:{environment['PATH']}"
    (checkout / "out").mkdir(exist_ok=True)
    ended = subprocess.run(
        ["bash", "-c", command],
        cwd=checkout,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_most_commands_of_the_checkout_are_run():
    """How many there are of each kind; pytest -s shows them."""
    counted = {"run here": len(RUN)}
    for command in FOUND:
        if command not in RUN:
            why = next(why for pattern, why in NOT_RUN.items() if re.match(pattern, command))
            counted[why] = counted.get(why, 0) + 1
    print(f"{len(FOUND)} commands in {', '.join(map(name_of, PAGES))}: {counted}")
    assert counted["run here"] >= 4
