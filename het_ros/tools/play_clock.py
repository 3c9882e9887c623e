# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A bag's stamps moved to the time at which it is played, and back."""

from __future__ import annotations

import struct

SECOND = 1_000_000_000  # ns
STAMP = struct.Struct("<iI")  # s and ns of a header, the first field of a message
STAMP_AT = 4  # bytes: after the CDR's own header


class PlayClock:
    """Moves stamps (ns) so that the first that is played is the moment of :meth:`begin`.

    The same stamp always becomes the same, so that a box still names its image.

    Args:
        rate: 2 is twice as fast: the time between two stamps is halved.
    """

    def __init__(self, rate: float = 1.0) -> None:
        self._now = 0
        self._rate = rate
        self._first: int | None = None
        self._recorded: dict[int, int] = {}

    def begin(self, now: int) -> None:
        """The play begins at ``now``, ns."""
        self._now = now

    def played(self, recorded: int) -> int:
        """The stamp that a recorded one is played with; 0, no stamp, stays 0."""
        if recorded == 0:
            return 0
        if self._first is None:
            self._first = recorded
        stamp = self._now + round((recorded - self._first) / self._rate)
        self._recorded[stamp] = recorded
        return stamp

    def recorded(self, played: int) -> int:
        """The recorded stamp of one that was played; any other as it is."""
        return self._recorded.get(played, played)


def restamped(cdr: bytes, stamp: int) -> bytes:
    """A serialised message that begins with a header, with another stamp (ns)."""
    return cdr[:STAMP_AT] + STAMP.pack(*divmod(stamp, SECOND)) + cdr[STAMP_AT + STAMP.size :]
