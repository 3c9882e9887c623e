# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A camera with faults: a bag's images at a steady rate, some lost, late, doubled or misstamped.

To see what your robot does when its camera fails, without taking a camera apart.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import rclpy
from geometry_msgs.msg import PolygonStamped
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from het_ros.bench.camera import QOS
from het_ros.faults.disturb import (
    SECOND,
    Delivery,
    delay,
    duplicate,
    freeze,
    lose,
    shift,
    steady,
    swap,
)
from het_ros.ros.messages import header_of, polygon_from_box
from het_ros.tools.arguments import INTERRUPTED, command, split_ros_arguments
from het_ros.tools.bag_reader import BagError, BagReader
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.message_types import message_class
from het_ros.tools.transport import use_profile

STAMP_AT = 4  # byte of a CDR message that begins with a header
BOX_EVERY = 30  # frames
WAIT = 10.0  # s for somebody to listen

EXAMPLE = """examples, with a tracker that runs with -p image_transport:=compressed:
  ros2 run het_ros faulty_camera bags/follow_walk --lose 0.3
  ros2 run het_ros faulty_camera bags/follow_walk --delay 0.2 --by 0.15 --rounds 10
  ros2 run het_ros faulty_camera bags/follow_walk --jump 100,-5
"""


class FaultyCamera(Node):
    """Publishes the images of a bag, with whatever stamps.

    Args:
        bag: its images are kept in memory as they lie in the bag.
        boxes: topic to send the bag's true boxes to, one a second; "" for none.
    """

    def __init__(self, bag: BagReader, boxes: str = "") -> None:
        super().__init__("faulty_camera")
        self._truth = list(bag.truth().values()) if boxes else []
        self._boxes = self.create_publisher(PolygonStamped, boxes, 10) if boxes else None
        self._images = [recorded.cdr for recorded in bag.recorded(bag.image_topic)]
        kind = message_class(bag.topics[bag.image_topic])
        self._publisher = self.create_publisher(kind, bag.image_topic, QOS)

    def __len__(self) -> int:
        """Number of images."""
        return len(self._images)

    def heard(self) -> bool:
        """Whether anybody takes the images."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, delivery: Delivery) -> None:
        """Send one image; after the last the first comes again."""
        index = delivery.frame % len(self._images)
        cdr = self._images[index]
        seconds, rest = divmod(delivery.stamp, SECOND)
        stamp = seconds.to_bytes(4, "little", signed=True) + rest.to_bytes(4, "little")
        self._publisher.publish(cdr[:STAMP_AT] + stamp + cdr[STAMP_AT + 8 :])
        if self._boxes and delivery.frame % BOX_EVERY == 0 and index < len(self._truth):
            header = header_of(delivery.stamp)
            self._boxes.publish(polygon_from_box(self._truth[index], header))


def play(camera: FaultyCamera, stream: Sequence[Delivery], stop: StopRequest) -> int:
    """Publish every delivery when it is due; how many were sent until then or the stop."""
    begun = time.monotonic()
    for sent, delivery in enumerate(stream):
        while not stop and (left := begun + delivery.due - time.monotonic()) > 0:
            time.sleep(min(left, 0.05))
        if stop:
            return sent
        camera.publish(delivery)
    return len(stream)


def disturbed(options: argparse.Namespace, frames: int) -> list[Delivery]:
    """The stream that the command line asks for."""
    rng = np.random.default_rng(options.seed)
    first = round(options.first_stamp * SECOND) if options.first_stamp else time.time_ns()
    stream = steady(frames * options.rounds, options.rate, first)
    if options.freeze:
        stream = freeze(stream, *(int(number) for number in options.freeze.split(",")))
    if options.jump:
        frame, seconds = options.jump.split(",")
        stream = shift(stream, int(frame), float(seconds))
    stream = lose(stream, options.lose, rng)
    stream = duplicate(stream, options.duplicate, rng)
    stream = swap(stream, options.swap, rng)
    return delay(stream, options.delay, options.by, rng)


def _parse(argv: Sequence[str]) -> argparse.Namespace:
    p = command("camera", __doc__, EXAMPLE)
    p.add_argument("bag", type=Path, help="folder of a rosbag2 with images")
    p.add_argument("--rate", type=float, default=30.0, help="frames/s (30)")
    p.add_argument("--rounds", type=int, default=1, help="times the bag is played (1)")
    p.add_argument("--lose", type=float, default=0.0, help="share of frames lost, 0..1 (0)")
    p.add_argument("--duplicate", type=float, default=0.0, help="share sent twice (0)")
    p.add_argument("--swap", type=float, default=0.0, help="share that trades places (0)")
    p.add_argument("--delay", type=float, default=0.0, help="share that comes late (0)")
    p.add_argument("--by", type=float, default=0.1, help="s that those are late at most (0.1)")
    p.add_argument("--freeze", default="", help="FIRST,LAST: frames with one and the same stamp")
    p.add_argument("--jump", default="", help="FRAME,SECONDS: the clock is set there")
    p.add_argument("--first-stamp", type=float, default=0.0, help="s (0: the time of day)")
    p.add_argument("--boxes", default="", help="topic for the bag's true boxes, one a second")
    p.add_argument("--seed", type=int, default=0, help="of what is drawn (0)")
    p.add_argument("--wait", type=float, default=WAIT, help=f"s for a listener ({WAIT:g})")
    return p.parse_args(argv)


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    own, ros = split_ros_arguments(argv)
    options = _parse(own)
    use_profile()
    try:
        with BagReader(options.bag) as bag, StopRequest() as stop:
            if not bag.image_topic:
                raise BagError(f"{options.bag} has no images")
            rclpy.init(args=ros, signal_handler_options=SignalHandlerOptions.NO)
            try:
                return _run(FaultyCamera(bag, options.boxes), options, stop)
            finally:
                rclpy.try_shutdown()
    except (OSError, ValueError) as error:
        print(f"camera: {error}", file=sys.stderr)
        return 1


def _run(camera: FaultyCamera, options: argparse.Namespace, stop: StopRequest) -> int:
    try:
        stream = disturbed(options, len(camera))
        end = time.monotonic() + options.wait
        while not stop and not camera.heard():
            if time.monotonic() > end:
                raise ValueError(f"nobody took the images within {options.wait:g} s")
            time.sleep(0.02)
        sent = play(camera, stream, stop)
        print(f"{sent} of {len(stream)} frames sent")
        return INTERRUPTED if stop else 0
    finally:
        camera.destroy_node()


if __name__ == "__main__":
    sys.exit(main())
