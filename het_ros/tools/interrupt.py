# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C that ends a long job between two frames instead of in the middle of one."""

from __future__ import annotations

import signal
from types import FrameType
from typing import Any


class StopRequest:
    """While it is entered, SIGINT and SIGTERM only set ``requested``; loops look at it.

    What was written so far is then closed properly. A second signal raises KeyboardInterrupt, for
    those who cannot wait. Enter it in the main thread.
    """

    SIGNALS = (signal.SIGINT, signal.SIGTERM)

    def __init__(self) -> None:
        self.requested = False
        self._before: dict[int, Any] = {}

    def __bool__(self) -> bool:
        return self.requested

    def __enter__(self) -> StopRequest:
        self._before = {number: signal.signal(number, self._on_signal) for number in self.SIGNALS}
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        if self.requested:
            raise KeyboardInterrupt
        self.requested = True
