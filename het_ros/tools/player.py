# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Publish a bag's images and boxes, byte by byte as they were recorded."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from het_ros.tools.bag_messages import (
    CAMERA_INFO,
    COMPRESSED_IMAGE,
    IMAGE,
    INIT_BOX_TOPIC,
    POLYGON,
    box_message,
)
from het_ros.tools.bag_reader import BagError, BagReader, Recorded, header_stamp
from het_ros.tools.bag_writer import TYPESTORE
from het_ros.tools.handshake import LONGEST_SPIN, NobodyListensError, Spin
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.message_types import check_types, message_class
from het_ros.tools.play_clock import PlayClock, restamped
from het_ros.tracking.box import Box

PLAYED_TYPES = (
    IMAGE,
    COMPRESSED_IMAGE,
    POLYGON,
    CAMERA_INFO,
    "sensor_msgs/msg/RegionOfInterest",
)
STAMPED = set(PLAYED_TYPES) - {"sensor_msgs/msg/RegionOfInterest"}
QOS = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
CATCH_UP = 0.8  # of the time between two messages is kept even when a play is late


def timeline(
    bag: BagReader, init: Box | None = None, without_box: bool = False
) -> Iterator[Recorded]:
    """What is to be played of a bag, in the order of recording.

    Args:
        bag: its image, camera info and box topics are taken.
        init: a target to start with, px; it is put after the first image, with its stamp, and
            the bag's own init boxes are left out.
        without_box: leave the bag's own init boxes out in any case.

    Raises:
        BagError: the bag has no images, or a type that is not ROS 2 Jazzy's.
    """
    topics = played_topics(bag, init, without_box)
    sent = False
    for recorded in bag.recorded(*(topic for topic in topics if topic in bag.topics)):
        if (init or without_box) and recorded.topic == INIT_BOX_TOPIC:
            continue
        yield recorded
        if init and not sent and recorded.topic == bag.image_topic:
            message = box_message(init, header_stamp(recorded.cdr), "")
            cdr = bytes(TYPESTORE.serialize_cdr(message, POLYGON))
            yield Recorded(INIT_BOX_TOPIC, POLYGON, recorded.time, cdr)
            sent = True


def played_topics(
    bag: BagReader, init: Box | None = None, without_box: bool = False
) -> dict[str, str]:
    """Topic and type of all that :func:`timeline` yields, each type checked.

    Raises:
        BagError: the bag has no images, or a type that is not ROS 2 Jazzy's.
    """
    if not bag.image_topic:
        listed = ", ".join(bag.topics) or "nothing"
        raise BagError(f"{bag.path} has no images to play; it holds {listed}")
    topics = {topic: kind for topic, kind in bag.topics.items() if kind in PLAYED_TYPES}
    check_types(bag, list(topics))
    if without_box:
        topics.pop(INIT_BOX_TOPIC, None)
    return topics | {INIT_BOX_TOPIC: POLYGON} if init else topics


class Player:
    """The publishers of one bag.

    Args:
        node: makes the publishers.
        bag: what to play, see :func:`timeline`.
        tracker: full name of the tracker's node; init boxes go to its ``~/init_box``.
        init: a target to start with instead of the bag's own.
        without_box: leave the bag's own init boxes out: who plays sends one.
        clock: stamps everything anew; by default stamps stay as they are.

    Raises:
        BagError: the bag has no images, or a type that is not ROS 2 Jazzy's.
    """

    def __init__(
        self,
        node: Node,
        bag: BagReader,
        tracker: str,
        init: Box | None = None,
        without_box: bool = False,
        clock: PlayClock | None = None,
    ) -> None:
        self.bag = bag
        self.init = init
        self._without_box = without_box
        self._clock = clock
        topics = played_topics(bag, init, without_box)
        self._publishers = {
            topic: node.create_publisher(
                message_class(kind),
                f"{tracker}/init_box" if topic == INIT_BOX_TOPIC else topic,
                QOS,
            )
            for topic, kind in topics.items()
        }

    def wait_for_subscriber(self, spin: Spin, seconds: float, stop: StopRequest) -> None:
        """Return as soon as somebody takes the images and, if there is one, the init box.

        Raises:
            NobodyListensError: nobody came; the text says what to look at.
        """
        needed = [
            p for t, p in self._publishers.items() if t in (self.bag.image_topic, INIT_BOX_TOPIC)
        ]
        end = time.monotonic() + seconds
        while not stop:
            missing = [p.topic_name for p in needed if not p.get_subscription_count()]
            if not missing:
                return
            if time.monotonic() > end:
                raise NobodyListensError(self._nobody(missing, seconds))
            spin(LONGEST_SPIN)

    def publish(self, recorded: Recorded) -> None:
        """Send one message as it is, or with the time of the play."""
        cdr = recorded.cdr
        if self._clock is not None and recorded.kind in STAMPED:
            cdr = restamped(cdr, self._clock.played(header_stamp(cdr)))
        self._publishers[recorded.topic].publish(cdr)

    def in_real_time(self, spin: Spin, rate: float, stop: StopRequest) -> Iterator[Recorded]:
        """Publish every message when it is due and hand it on.

        Whoever takes the newest image only would miss one of two that come at once. So a play
        that was held up catches up little by little, as no camera sends images in bursts.

        Args:
            spin: serves other callbacks for at most so many seconds.
            rate: 1 is real time, 2 twice as fast.
            stop: ends the play.
        """
        previous: int | None = None
        due = published = time.monotonic()
        for recorded in timeline(self.bag, self.init, self._without_box):
            step = 0.0 if previous is None else (recorded.time - previous) * 1e-9 / rate
            due, previous = due + step, recorded.time
            due_now = max(due, published + CATCH_UP * step)
            while not stop and (left := due_now - time.monotonic()) > 0:
                spin(min(left, LONGEST_SPIN))
            if stop:
                return
            self.publish(recorded)
            published = time.monotonic()
            yield recorded

    def _nobody(self, missing: list[str], seconds: float) -> str:
        domain = os.environ.get("ROS_DOMAIN_ID", "0")
        text = (
            f"nobody subscribed to {' and '.join(missing)} within {seconds:g} s "
            f"(ROS_DOMAIN_ID {domain}): start the tracker first"
        )
        images = self._publishers[self.bag.image_topic].topic_name
        if images not in missing:
            return f"{text}, or give its name with --tracker /namespace/name"
        kind = "CompressedImage" if self.bag.compressed else "Image"
        transport = "compressed" if self.bag.compressed else "raw"
        return f"{text}; it has to take {kind} (-p image_transport:={transport}) on {images}"
