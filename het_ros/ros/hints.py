# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Log lines that help once, or some times, and then keep quiet."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import Any

MOST_LINES, RATION_SECONDS = 20, 10.0


class Hints:
    """Warns at most once a key, so that a fault in every frame fills no disk.

    A key is heard again after :meth:`forget`, for example when the fault went away.
    """

    def __init__(self, logger: Any) -> None:
        self._logger = logger
        self._given: set[str] = set()

    def once(self, key: str, text: str) -> None:
        """Log ``text`` as a warning unless the key was heard already."""
        if key not in self._given:
            self._given.add(key)
            self._logger.warning(text)

    def forget(self, key: str) -> None:
        """Let the key be heard again."""
        self._given.discard(key)


class Ration:
    """Lets lines into the log so seldom that a flood of what others bring about fills no disk.

    Args:
        most: lines in any ``seconds``; what comes beyond is counted, and told with the next line.
        seconds: s.
        clock: monotonic, s.
    """

    def __init__(
        self,
        most: int = MOST_LINES,
        seconds: float = RATION_SECONDS,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._seconds = seconds
        self._clock = clock
        self._logged: deque[float] = deque(maxlen=most)
        self._kept_back = 0

    def line(self, text: str) -> str:
        """What is to be logged now; empty where nothing is."""
        now = self._clock()
        if len(self._logged) == self._logged.maxlen and now - self._logged[0] < self._seconds:
            self._kept_back += 1
            return ""
        self._logged.append(now)
        more = f" ({self._kept_back} more like it were not logged)" if self._kept_back else ""
        self._kept_back = 0
        return f"{text}{more}"
