# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Record what a tracker publishes, with the stamps of its input."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from het_ros.ros.input_hints import NEEDS
from het_ros.tools.bag_messages import CAMERA_INFO, COMPRESSED_IMAGE, IMAGE
from het_ros.tools.bag_reader import BagReader, header_stamp
from het_ros.tools.bag_writer import BagWriter
from het_ros.tools.message_types import message_class
from het_ros.tools.outputs import DEFAULT_TRACKER, OUTPUT_TYPES
from het_ros.tools.play_clock import PlayClock, restamped

QOS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)


def outputs_from(bag: BagReader) -> list[str]:
    """The outputs that a tracker can publish from what a bag holds.

    What it cannot is left out, for it would warn that somebody waits for that.
    """
    kinds = list(bag.topics.values())
    missing: set[str] = set()
    if sum(kind in (IMAGE, COMPRESSED_IMAGE) for kind in kinds) < 2:  # the camera's alone
        missing.add("depth")
    if CAMERA_INFO not in kinds:
        missing.add("camera_info")
    return [name for name in OUTPUT_TYPES if missing.isdisjoint(NEEDS.get(name, ()))]


class Recorder:
    """Writes a tracker's outputs into a bag as they come in, CDR bytes as they are.

    Each message is logged at its header's stamp, that is at the time of the image that it answers:
    the recording lies over its input and does not depend on how fast the input was played.

    Args:
        node: makes the subscriptions; somebody spins it.
        bag: open bag to write to.
        tracker: full name of the tracker's node.
        clock: of a play with stamps of its own; the recording has the bag's.
        on_failure: is called when the bag takes no more, instead of an error in the callback.
        outputs: names of those that are recorded.

    Attributes:
        answered: stamps (ns) of the frames for which a status came.
        size: bytes of the messages that were recorded.
    """

    def __init__(
        self,
        node: Node,
        bag: BagWriter,
        tracker: str = DEFAULT_TRACKER,
        clock: PlayClock | None = None,
        on_failure: Callable[[OSError], None] | None = None,
        outputs: Collection[str] = tuple(OUTPUT_TYPES),
    ) -> None:
        self._node = node
        self._bag = bag
        self._clock = clock
        self._on_failure = on_failure
        self.answered: set[int] = set()
        self.size = 0
        self._status_topic = f"{tracker}/status"
        self._subscriptions = [
            self._subscribe(node, f"{tracker}/{name}", OUTPUT_TYPES[name]) for name in outputs
        ]

    @property
    def connected(self) -> bool:
        """Whether the tracker's status can be heard."""
        return any(
            s.topic_name == self._status_topic and s.get_publisher_count() > 0
            for s in self._subscriptions
        )

    def close(self) -> None:
        """Take the subscriptions away; the bag is the caller's."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()

    def _subscribe(self, node: Node, topic: str, kind: str) -> Any:
        self._bag.add_topic(topic, kind)
        callback = self._writing(topic, kind)
        return node.create_subscription(message_class(kind), topic, callback, QOS, raw=True)

    def _writing(self, topic: str, kind: str) -> Callable[[bytes], None]:
        def write(cdr: bytes) -> None:
            stamp = header_stamp(cdr)
            if self._clock is not None:
                stamp = self._clock.recorded(stamp)
                cdr = restamped(bytes(cdr), stamp)
            try:
                self._bag.write_cdr(topic, kind, cdr, stamp)
            except OSError as error:
                if self._on_failure is None:
                    raise
                self._on_failure(error)
                return
            self.size += len(cdr)
            if topic == self._status_topic:
                self.answered.add(stamp)

        return write
