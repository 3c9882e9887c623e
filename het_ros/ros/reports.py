# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the node says while nothing comes in: log, ``~/status`` and ``/diagnostics``."""

from __future__ import annotations

from collections import Counter

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.node import Node

from het_ros.ros.answers import Answers
from het_ros.ros.image_stream import ImageStream
from het_ros.ros.pursuit import Pursuit
from het_ros.ros.status import Status
from het_ros.ros.watch import Watch
from het_ros.tracking.estimate import State

TELL = 1.0  # s between two statuses while no image comes


class Reports:
    """Tells of a stream that stands still, and of how the node does.

    A silence changes nothing of the track, which goes on if images come again within ``max_gap``;
    but what a robot hears meanwhile is LOST, since nobody knows where the target is.

    Attributes:
        watch: knows for how long no image was processed.

    Args:
        node: logs, and has the clock.
        pursuit: the frames and the track.
        answers: publish the statuses.
    """

    def __init__(self, node: Node, pursuit: Pursuit, answers: Answers) -> None:
        self._node = node
        self._pursuit = pursuit
        self._answers = answers
        self.watch = Watch(lambda: pursuit.counts)

    @property
    def state(self) -> State:
        """Where the track stands; LOST while no image comes that could tell."""
        state = self._pursuit.session.state
        return State.LOST if self.watch.told and state is not State.IDLE else state

    @property
    def reason(self) -> str:
        """Why :attr:`state` is not TRACKING; empty while it is."""
        return self.watch.reason() if self.watch.told else self._pursuit.session.reason

    def processed(self) -> None:
        """An image was processed."""
        if lasted := self.watch.begin():
            self._node.get_logger().info(f"images come again, after {lasted:.1f} s")

    def look(self, images: ImageStream) -> None:
        """Tell of a silence once in the log, and once a second on ``~/status``."""
        first = not self.watch.told
        if not self.watch.due(self._answers.settings.image_timeout, TELL):
            return
        if first:
            self._node.get_logger().warning(f"{self.reason}: {images.waiting_on()}")
        age = self._pursuit.session.age + self.watch.silent
        status = Status(self.state, 0.0, 0.0, age, self.reason, trouble=True)
        now = self._node.get_clock().now().to_msg()
        self._answers.publish_silence(status, self._pursuit.newest, now)

    def diagnostics(self, dropped: int, working: bool) -> DiagnosticArray:
        """The message for ``/diagnostics``.

        Args:
            dropped: images that never came.
            working: whether images are to be processed.
        """
        newest = self._pursuit.newest
        return self._answers.health.report(
            self._node.get_fully_qualified_name(),
            newest.header.frame_id if newest else "",
            self._node.get_clock().now().to_msg(),
            self._answers.settings.diagnostics_period,
            self._pursuit.counts | Counter(dropped=dropped),
            self.state,
            working,
            self.reason if self.watch.told else "",
        )
