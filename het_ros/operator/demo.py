# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page on recorded footage: tracker, operator and a camera that plays it to and fro.

The images are stamped with the time at which they are sent, as a camera's are, and footage that
has come to its end is played backwards, so that no cut in it loses the target.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from het_ros.tools.arguments import add_image_topic, add_network, add_parameters, command
from het_ros.tools.bag_messages import TRUTH_BOX_TOPIC
from het_ros.tools.bag_reader import BagError, BagReader, Recorded, header_stamp
from het_ros.tools.footage import open_footage
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.make_bag import make_bag
from het_ros.tools.message_types import check_types, message_class
from het_ros.tools.player import QOS
from het_ros.tools.report import remove_bag
from het_ros.tools.run import shipped_bag
from het_ros.tools.tracker_arguments import tracker_arguments
from het_ros.tools.tracker_process import (
    TrackerProcess,
    TrackerProcessError,
    find_tracker,
    own_graph,
)
from het_ros.tools.transport import use_profile
from het_ros.tracking.box import Box

MOST = 2e9  # bytes of footage that are kept in memory; what is longer is played in part
LONGEST_SPIN = 0.01  # s
LATEST = 20_000_000  # ns that an image may be sent late
NO_BOX = Box(0, 0, 16, 16)  # a bag has to have one; here it is not played

EXAMPLE = """examples:
  python -m het_ros.operator.demo
  python -m het_ros.operator.demo --video walk.mp4
  python -m het_ros.operator.demo --sequence sequences/Crossing -o host:=0.0.0.0
  python -m het_ros.operator.demo --network models/nanotrackv3
"""


class Camera:
    """Publishes a bag's images, and its ground truth, to and fro in real time.

    Args:
        node: publishes.
        bag: its images and ground truth are taken; init boxes are left to the operator.
        rate: 1 is real time.

    Attributes:
        played: recorded stamp of each image that was sent, by the stamp it was sent with, ns.

    Raises:
        BagError: the bag has no images.
    """

    def __init__(self, node: Node, bag: BagReader, rate: float = 1.0) -> None:
        if not bag.image_topic:
            raise BagError(f"{bag.path} has no images to play")
        topics = [t for t in (TRUTH_BOX_TOPIC, bag.image_topic) if t in bag.topics]
        check_types(bag, topics)
        self.played: dict[int, int] = {}
        self._image_topic, self._rate = bag.image_topic, rate
        self._publishers = {
            topic: node.create_publisher(message_class(bag.topics[topic]), topic, QOS)
            for topic in topics
        }
        self._clock = node.get_clock()
        self._messages = list(_first_of(bag, topics))
        if not any(m.topic == self._image_topic for m in self._messages):
            raise BagError(f"{bag.path} has no images to play")
        self._order = _to_and_fro(len(self._messages))
        self._at = 0
        self._due = self._clock.now().nanoseconds

    def seconds_left(self) -> float:
        """Time until the next message is due, s."""
        return (self._due - self._clock.now().nanoseconds) * 1e-9

    def send(self) -> None:
        """Publish the next message; a camera that was held up does not catch up."""
        message = self._messages[self._at]
        seconds, nanoseconds = divmod(self._due, 10**9)
        stamp = seconds.to_bytes(4, "little") + nanoseconds.to_bytes(4, "little")
        self._publishers[message.topic].publish(message.cdr[:4] + stamp + message.cdr[12:])
        if message.topic == self._image_topic:
            self.played[self._due] = header_stamp(message.cdr)
        self._at = next(self._order)
        step = abs(self._messages[self._at].time - message.time)
        if step:  # else it belongs to the same image
            late = self._clock.now().nanoseconds - LATEST
            self._due = max(self._due + round(step / self._rate), late)


def _to_and_fro(count: int) -> Iterator[int]:
    """1, 2 ... count - 1, count - 2 ... 0, 1 ..."""
    while True:
        yield from range(1, count)
        yield from range(count - 2, -1, -1)
        if count == 1:
            yield 0


def _first_of(bag: BagReader, topics: list[str]) -> Iterator[Recorded]:
    size = 0
    for recorded in bag.recorded(*topics):
        size += len(recorded.cdr)
        if size > MOST:
            print("operator: only the first 2 GB of the footage are played", file=sys.stderr)
            return
        yield recorded


def show(bag: BagReader, folder: Path, options: argparse.Namespace) -> None:
    """Play a bag to a tracker and an operator in a ROS domain of their own, until Ctrl-C.

    Raises:
        BagError, TrackerProcessError: what stood in the way.
    """
    os.environ.update(own_graph())
    use_profile()
    tracker = options.tracker or find_tracker()
    operator = tracker.with_name("operator")
    log, page_log = folder / "tracker.log", folder / "operator.log"
    settings = ["--ros-args", "-p", f"recordings:={folder / 'recordings'}"]
    settings += [word for setting in options.operator for word in ("-p", setting)]
    with ExitStack() as open_things:
        stop = open_things.enter_context(StopRequest())
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        open_things.callback(rclpy.try_shutdown)
        node = rclpy.create_node("camera")
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        camera = Camera(node, bag, options.rate)
        arguments = tracker_arguments(bag, options.parameters)
        processes = [
            open_things.enter_context(TrackerProcess(tracker, arguments, log)),
            open_things.enter_context(TrackerProcess(operator, settings, page_log)),
        ]
        told = False
        while not stop:
            executor.spin_once(timeout_sec=min(max(camera.seconds_left(), 0), LONGEST_SPIN))
            if camera.seconds_left() <= 0:
                camera.send()
                for process in processes:
                    process.check()
            if not told and "open http" in (said := page_log.read_text(errors="replace")):
                print(said.rstrip(), "\nCtrl-C ends it", flush=True)
                told = True


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    parser = command("operator demo", __doc__, EXAMPLE)
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--bag", type=Path, help="a rosbag2 (default: the shipped walk)")
    source.add_argument("--video", type=Path, help="a video file")
    source.add_argument("--sequence", type=Path, help="a folder of images")
    parser.add_argument("--out", type=Path, default=Path("out/operator"), help="logs, recordings")
    parser.add_argument("--fps", type=float, help="frames/s of a video or sequence")
    parser.add_argument("--rate", type=float, default=1.0, help="2 plays twice as fast")
    parser.add_argument("--tracker", type=Path, help="executable (default: the installed one)")
    parser.add_argument(
        "-o", dest="operator", action="append", default=[], metavar="NAME:=VALUE",
        help="a parameter of the operator: host:=0.0.0.0",
    )  # fmt: skip
    add_image_topic(parser)
    add_network(parser)
    add_parameters(parser)
    options = parser.parse_args(argv)
    if options.network:
        options.parameters.append(f"network:={options.network}")
    return options


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    options = _parse(argv)
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        footage, path = options.video or options.sequence, options.bag or shipped_bag()
        if footage:
            path = options.out / "input"
            remove_bag(path)
            make_bag(open_footage(footage), path, init=NO_BOX, rate=options.fps)
        with BagReader(path, options.image_topic) as bag:
            show(bag, options.out, options)
    except (OSError, ValueError, TrackerProcessError) as error:
        print(f"operator: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    return 0


if __name__ == "__main__":
    sys.exit(main())
