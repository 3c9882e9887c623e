# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Says which input an output waits for that somebody subscribes to and nobody gets."""

from __future__ import annotations

import time
from collections.abc import Callable

from rclpy.node import Node

from het_ros.ros.hints import Hints
from het_ros.ros.outputs import Outputs
from het_ros.ros.silence import publishers_of
from het_ros.ros.space import Space

_WITH_DEPTH = "camera_info", "depth"
NEEDS = {  # inputs by output
    "bearing": ("camera_info",),
    "target_pose": _WITH_DEPTH,
    "target_pose_cov": _WITH_DEPTH,
    "target_velocity": _WITH_DEPTH,
}
PATIENCE = 3.0  # s that an output is subscribed to without its inputs


class InputHints:
    """Looks after outputs that need more than images.

    Args:
        node: its remappings tell the topics.
        space: knows what came in.
        hints: each input is told of once.
        clock: monotonic, s.
    """

    def __init__(
        self,
        node: Node,
        space: Space,
        hints: Hints,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._node = node
        self._space = space
        self._hints = hints
        self._clock = clock
        self._heard: dict[str, float] = {}
        self._told: set[str] = set()

    def look(self, outputs: Outputs) -> None:
        """Log, once each, which inputs are missing for an output that is subscribed to."""
        now = self._clock()
        for output, inputs in NEEDS.items():
            if not outputs.heard(output):
                self._heard.pop(output, None)
                continue
            since = self._heard.setdefault(output, now)
            for topic in inputs:
                missing = topic not in self._space.came and topic not in self._told
                if missing and now - since >= PATIENCE:
                    self._told.add(topic)
                    self._say(output, topic)

    def _say(self, output: str, name: str) -> None:
        topic = self._node.resolve_topic_name(name)
        found = publishers_of(self._node, topic)
        self._hints.once(
            f"input {name}",
            f"~/{output} is subscribed to, but nothing comes on {topic}, which it needs; its "
            f"publishers: {found or f'none, remap with -r {name}:=/your/camera/{name}'}",
        )
