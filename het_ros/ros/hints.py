"""Log lines that help once and then keep quiet."""

from __future__ import annotations

from typing import Any


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
