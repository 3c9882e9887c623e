# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a frame's stamp says of the stream: next, seen already, late, or time gone back."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

SECOND = 1_000_000_000  # ns


class Order(Enum):
    """How a stamp follows the newest one before it."""

    NEXT = "next"
    DUPLICATE = "duplicate"  # the same stamp again
    LATE = "late"  # older than the newest, by little: frames changed places on the way
    JUMP_BACK = "jump back"  # older by much: a bag looped, a clock was set


@dataclass
class StampGate:
    """Sorts stamps as they come in and counts what it turns away.

    Attributes:
        jump_back: s; a stamp older than the newest by this or more is a jump, not a late frame.
        newest: newest stamp let through, ns; None before the first.
        dropped: how many stamps of each refused order came in.
    """

    jump_back: float = 1.0
    newest: int | None = None
    dropped: dict[Order, int] = field(default_factory=lambda: {Order.DUPLICATE: 0, Order.LATE: 0})

    def take(self, stamp: int) -> Order:
        """Judge a stamp (ns); NEXT and JUMP_BACK make it the newest, the others are counted."""
        order = self._order(stamp)
        if order in self.dropped:
            self.dropped[order] += 1
        else:
            self.newest = stamp
        return order

    def _order(self, stamp: int) -> Order:
        if self.newest is None or stamp > self.newest:
            return Order.NEXT
        if stamp == self.newest:
            return Order.DUPLICATE
        return Order.JUMP_BACK if self.newest - stamp >= self.jump_back * SECOND else Order.LATE
