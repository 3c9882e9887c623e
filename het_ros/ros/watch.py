# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Notices that no new image is processed any more, and tells why."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable

# What may become of images that come in but lead to nothing, and what a log says of it.
CAUSES = {
    "duplicate": "{} came with the stamp of the one before: does the camera's clock stand still?",
    "late": "{} came with older stamps than the newest: do two cameras publish here?",
    "unreadable": "{} could not be read",
}


class Watch:
    """For how long no image was processed; all times s of a monotonic clock.

    Args:
        counts: images by what became of them, since the start.
        clock: monotonic, s.
    """

    def __init__(
        self, counts: Callable[[], Counter[str]], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._counts = counts
        self._clock = clock
        self._told: float | None = None
        self.begin()

    @property
    def told(self) -> bool:
        """Whether the silence was told of, and lasts."""
        return self._told is not None

    @property
    def silent(self) -> float:
        """How long no image has been processed, s."""
        return self._clock() - self._since

    def begin(self) -> float:
        """Count from now on, since an image was processed or is expected again.

        Returns:
            The length of the silence that was told of, s; 0 where none was.
        """
        lasted = self.silent if self.told else 0.0
        self._since = self._clock()
        self._told = None
        self._before: Counter[str] | None = None
        return lasted

    def due(self, timeout: float, every: float) -> bool:
        """Whether to tell of the silence now: after ``timeout`` s, and ``every`` s from then on.

        0 as ``timeout`` is never.
        """
        if self._before is None:
            self._before = self._counts().copy()
        if timeout <= 0 or self.silent < timeout:
            return False
        now = self._clock()
        if self._told is not None and now - self._told < every:
            return False
        self._told = now
        return True

    def reason(self) -> str:
        """Why no image is processed."""
        since = self._counts() - (self._before or Counter())
        causes = [text.format(since[what]) for what, text in CAUSES.items() if since[what]]
        if not causes:
            return f"no image for {self.silent:.1f} s"
        return f"no new image for {self.silent:.1f} s: {'; '.join(causes)}"
