# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Recordings of what trackers publish, one at a time each, started and stopped by browsers."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from rclpy.node import Node

from het_ros.operator.config import OperatorConfig
from het_ros.operator.messages import Answer


class Recordings:
    """Bags of results; used from the thread that spins the node alone.

    Args:
        node: subscribes to what is recorded.
        config: names the folder and the largest size.
    """

    def __init__(self, node: Node, config: OperatorConfig) -> None:
        self._node = node
        self._folder = Path(config.recordings).expanduser()
        self._most = config.max_recording * 1e6
        self._open: dict[str, tuple[Any, Any]] = {}

    @property
    def running(self) -> bool:
        """Whether there is any."""
        return bool(self._open)

    def start(self, tracker: str) -> Answer:
        """Begin a recording of one tracker."""
        if tracker in self._open:
            return Answer(False, "a recording is running already")
        try:
            from het_ros.tools.bag_writer import BagWriter
            from het_ros.tools.recorder import Recorder
        except ImportError as error:
            return Answer(False, f"recording needs rosbags: pip install rosbags ({error})")
        name = f"{tracker.strip('/').replace('/', '_')}_{time.strftime('%Y%m%d_%H%M%S')}"
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            bag = BagWriter(self._folder / name)
            bag.__enter__()
        except OSError as error:
            return Answer(False, str(error))
        recorder = Recorder(
            self._node, bag, tracker, on_failure=lambda error: self._end(tracker, error)
        )
        self._open[tracker] = (bag, recorder)
        return Answer(True, f"recording to {bag.path}")

    def stop(self, tracker: str) -> Answer:
        """End the recording of one tracker."""
        if tracker not in self._open:
            return Answer(False, "no recording is running")
        bag, recorder = self._open.pop(tracker)
        recorder.close()
        try:
            bag.__exit__(None, None, None)
        except OSError as error:
            return Answer(False, str(error))
        return Answer(True, f"recorded {bag.path}")

    def stop_all(self) -> None:
        """End every recording."""
        for tracker in tuple(self._open):
            self.stop(tracker)

    def state(self, tracker: str) -> dict[str, Any]:
        """The message that tells of a tracker's recording; one that is too large is ended."""
        path, size = "", 0
        if tracker in self._open:
            bag, recorder = self._open[tracker]
            path, size = str(bag.path), recorder.size
            if size > self._most:
                self._node.get_logger().warning(f"{self.stop(tracker).text}: it is full")
        on = tracker in self._open
        return {"type": "recording", "on": on, "path": path, "bytes": size}

    def _end(self, tracker: str, error: OSError) -> None:
        """The disk is full: what was recorded is kept."""
        self._node.get_logger().error(str(error))
        self.stop(tracker)
