# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Recordings of what trackers publish, one at a time each, started and stopped by browsers."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from rclpy.node import Node

from het_ros.commands import install_line
from het_ros.operator.config import OperatorConfig


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

    def start(self, tracker: str) -> str:
        """Begin a recording of one tracker; where to.

        Raises:
            ValueError: it is recorded already, or rosbags is not installed.
            OSError: the folder cannot be written.
        """
        if tracker in self._open:
            raise ValueError("a recording is running already")
        try:
            from het_ros.tools.bag_writer import BagWriter
            from het_ros.tools.recorder import Recorder
        except ModuleNotFoundError as error:
            raise ValueError(f"recording {install_line('rosbags')}") from error
        name = f"{tracker.strip('/').replace('/', '_')}_{time.strftime('%Y%m%d_%H%M%S')}"
        self._folder.mkdir(parents=True, exist_ok=True)
        bag = BagWriter(self._folder / name)
        bag.__enter__()
        recorder = Recorder(
            self._node, bag, tracker, on_failure=lambda error: self._end(tracker, str(error))
        )
        self._open[tracker] = (bag, recorder)
        return f"recording to {bag.path}"

    def stop(self, tracker: str) -> str:
        """End the recording of one tracker; where it is.

        Raises:
            ValueError: there is none.
            OSError: its end cannot be written.
        """
        if tracker not in self._open:
            raise ValueError("no recording is running")
        bag, recorder = self._open.pop(tracker)
        recorder.close()
        bag.__exit__(None, None, None)
        return f"recorded {bag.path}"

    def stop_all(self) -> None:
        """End every recording."""
        for tracker in tuple(self._open):
            self._end(tracker, "the operator ends")

    def state(self, tracker: str) -> dict[str, Any]:
        """The message that tells of a tracker's recording; one that is too large is ended."""
        path, size = "", 0
        if tracker in self._open:
            bag, recorder = self._open[tracker]
            path, size = str(bag.path), recorder.size
            if size > self._most:
                self._end(tracker, "it is as large as max_recording")
        on = tracker in self._open
        return {"type": "recording", "on": on, "path": path, "bytes": size}

    def _end(self, tracker: str, why: str) -> None:
        """End a recording that nobody ended; what was recorded is kept."""
        if tracker not in self._open:
            return  # another message of a full disk
        try:
            why = f"{self.stop(tracker)}: {why}"
        except OSError as error:
            why = f"{error}: {why}"
        self._node.get_logger().warning(why)
