# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How many images were published and never came here."""

from __future__ import annotations

from collections.abc import Callable


class Losses:
    """Counts the gaps in a publisher's own numbering of its messages.

    An image is missing because the way here lost it, or because a newer one took its place while
    this node was busy. With several publishers on the topic their numbers mix, and nothing is
    counted.

    Attributes:
        count: images that never came, since the first one that did.

    Args:
        publishers: tells how many there are; asked at a gap only.
    """

    def __init__(self, publishers: Callable[[], int]) -> None:
        self.count = 0
        self._publishers = publishers
        self._newest = 0

    def take(self, number: int | None) -> None:
        """Take the number of a message that came; None where the middleware gives none."""
        if number is None:
            return
        missing = number - self._newest - 1
        if self._newest > 0 and missing > 0 and self._publishers() == 1:
            self.count += missing
        self._newest = number
