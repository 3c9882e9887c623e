# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole way at once: start the installed tracker, play a bag to it, show what it answered.

The tracker is a process of its own, as ``ros2 run het_ros tracker`` starts it, and gets the frames
over DDS in real time.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from het_ros.tools.arguments import (
    INTERRUPTED,
    add_image_topic,
    add_init,
    add_network,
    add_parameters,
    command,
)
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.footage import open_footage
from het_ros.tools.handshake import NobodyListensError
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.make_bag import make_bag
from het_ros.tools.play import play
from het_ros.tools.report import ResultsFolder, remove_bag, write_report
from het_ros.tools.summary import Summary
from het_ros.tools.tracker_arguments import tracker_arguments
from het_ros.tools.tracker_process import (
    TrackerProcess,
    TrackerProcessError,
    find_tracker,
    own_graph,
)
from het_ros.tracking.box import Box

SHIPPED_BAG = Path("bags/follow_walk")
START_UP = 30.0  # s that a tracker may take to start on a small, busy computer

EXAMPLE = """examples:
  ros2 run het_ros run
  ros2 run het_ros run --sequence sequences/Crossing
  ros2 run het_ros run --video vtest.avi --init 258,219,33,89
  ros2 run het_ros run --bag bags/follow_walk -p seed:=3
  ros2 run het_ros run --network models/nanotrackv3
"""


def run(
    bag: BagReader,
    folder: ResultsFolder,
    executable: Path,
    *,
    init: Box | None = None,
    rate: float = 1.0,
    parameters: Sequence[str] = (),
    name: str = "",
) -> tuple[Summary, bool]:
    """Play a bag to a tracker that is started for it, in a ROS domain of its own, and report.

    Args:
        bag: what to play.
        folder: where results go, and ``tracker.log``.
        executable: the installed tracker.
        init: target in the first frame, px; by default the bag's own init box.
        rate: 1 is real time.
        parameters: of the tracker, each as "name:=value".
        name: what is played, for the picture's title; by default the bag's folder.

    Returns:
        The summary, and whether the whole bag was played (False after Ctrl-C).

    Raises:
        BagError, NobodyListensError, TrackerProcessError: what stood in the way.
    """
    os.environ.update(own_graph())
    log = folder.path / "tracker.log"
    folder.clear()
    with StopRequest() as stop:
        with TrackerProcess(executable, tracker_arguments(bag, parameters), log) as tracker:
            stamps = play(
                bag, folder.bag, stop, rate=rate, init=init, wait=START_UP, alive=tracker.check
            )
        return write_report(bag, stamps, folder, name=name), not stop


def _warnings(log: Path) -> list[str]:
    """What the tracker warned of, without time and name."""
    lines = log.read_text(errors="replace").splitlines()
    found = (
        re.match(r"\[(WARN|ERROR|FATAL)\] \[[\d.]+\] \[[^]]*\]: (.*)", line) for line in lines
    )
    return [match.group(2) for match in found if match]


def shipped_bag() -> Path:
    """The recorded walk of the checkout."""
    for parent in Path(__file__).resolve().parents:
        if (parent / SHIPPED_BAG).is_dir():
            return parent / SHIPPED_BAG
    return SHIPPED_BAG


def _bag_of_footage(source: Path, folder: ResultsFolder, options: argparse.Namespace) -> Path:
    """Make a bag from a video or a sequence inside the results folder."""
    path = folder.path / "input"
    remove_bag(path)
    with StopRequest() as stop:
        make_bag(open_footage(source), path, init=options.init, rate=options.fps, stop=stop)
        if stop:
            raise KeyboardInterrupt
    return path


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = command("run", __doc__, EXAMPLE)
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--bag", type=Path, help=f"a rosbag2 (default: {SHIPPED_BAG})")
    source.add_argument("--video", type=Path, help="a video file; needs --init")
    source.add_argument(
        "--sequence", type=Path, help="a folder with img/ and groundtruth_rect.txt"
    )
    add_init(parser)
    parser.add_argument("--out", type=Path, default=Path("out/run"), help="results folder")
    parser.add_argument("--fps", type=float, help="frames/s of a video or sequence")
    parser.add_argument("--rate", type=float, default=1.0, help="2 plays twice as fast")
    add_image_topic(parser)
    parser.add_argument("--tracker", type=Path, help="executable (default: the installed one)")
    add_network(parser)
    add_parameters(parser)
    options = parser.parse_args(argv)
    if options.network:
        options.parameters.append(f"network:={options.network}")
    if options.video and not options.init:
        parser.error("--video needs --init x,y,w,h: the target in its first frame, px")
    return options


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    options = _parse(argv)
    folder = ResultsFolder(options.out)
    try:
        executable = options.tracker or find_tracker()
        folder.path.mkdir(parents=True, exist_ok=True)
        footage = options.video or options.sequence
        path = _bag_of_footage(footage, folder, options) if footage else options.bag
        with BagReader(path or shipped_bag(), options.image_topic) as bag:
            summary, whole = run(
                bag,
                folder,
                executable,
                init=None if footage else options.init,
                rate=options.rate,
                parameters=options.parameters,
                name=footage.name if footage else "",
            )
    except (OSError, ValueError, NobodyListensError, TrackerProcessError) as error:
        print(f"run: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return INTERRUPTED
    for warning in _warnings(folder.path / "tracker.log"):
        print(f"tracker   {warning}")
    seen = [folder.video, folder.picture, folder.csv, folder.bag, folder.path / "tracker.log"]
    print("\n".join([*summary.lines(), "look at   " + "\n          ".join(map(str, seen))]))
    return 0 if whole else INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
