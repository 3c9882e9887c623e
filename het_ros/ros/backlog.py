# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames that wait to be processed, and which of them are left out to catch up."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from het_ros.ros.frames import Frame
from het_ros.ros.stamps import SECOND


class Backlog:
    """Frames in the order of their stamps.

    There is more than one while a late box catches up, or the oldest waits for its depth image.
    """

    def __init__(self) -> None:
        self._frames: deque[Frame] = deque()

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def next(self) -> Frame:
        """The oldest frame, which is taken next."""
        return self._frames[0]

    def add(self, frame: Frame) -> None:
        """Append a frame that is newer than all others."""
        self._frames.append(frame)

    def take(self) -> Frame:
        """Remove the oldest frame and return it."""
        return self._frames.popleft()

    def replace(self, frames: Iterable[Frame]) -> None:
        """Let only these frames wait."""
        self._frames = deque(frames)

    def skip(self, step_time: float) -> int:
        """Leave out so many frames that the backlog shrinks, but never the newest.

        A step of p s lets p / T new frames in (T: their interval); stepping over 2 p / T halves
        at least what is left behind.

        Args:
            step_time: how long the step took that was just done, s.

        Returns:
            How many frames were left out.
        """
        if len(self) < 2:
            return 0
        span = (self._frames[-1].stamp - self._frames[0].stamp) / SECOND
        if span <= 0:
            return 0
        interval = span / (len(self) - 1)
        skipped = min(int(2 * step_time / interval), len(self) - 1)
        for _ in range(skipped):
            self._frames.popleft()
        return skipped
