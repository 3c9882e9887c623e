# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bad streams of good ones: frames lost, doubled, late, in the wrong order, with wrong stamps.

Everything is a pure function from deliveries to deliveries, so that faults can be combined, and
the same generator gives the same fault.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

SECOND = 1_000_000_000  # ns


@dataclass(frozen=True)
class Delivery:
    """One frame on its way.

    Attributes:
        frame: number of the frame whose pixels it has.
        stamp: in its header, ns.
        due: when it arrives, s from the start of the stream.
    """

    frame: int
    stamp: int
    due: float


Stream = Sequence[Delivery]


def steady(frames: int, rate: float, first_stamp: int = 1000 * SECOND) -> list[Delivery]:
    """A good stream: ``rate`` frames/s, each stamped with its time."""
    times = [index / rate for index in range(frames)]
    return [Delivery(i, first_stamp + round(t * SECOND), t) for i, t in enumerate(times)]


def lose(stream: Stream, share: float, rng: np.random.Generator) -> list[Delivery]:
    """Without a share of the frames, 0..1, drawn at random; the first is never lost."""
    kept = rng.random(len(stream)) >= share
    return [delivery for i, delivery in enumerate(stream) if i == 0 or kept[i]]


def duplicate(stream: Stream, share: float, rng: np.random.Generator) -> list[Delivery]:
    """With a share of the frames sent twice in a row."""
    again = rng.random(len(stream)) < share
    return [d for i, delivery in enumerate(stream) for d in [delivery] * (1 + int(again[i]))]


def delay(
    stream: Stream, share: float, seconds: float, rng: np.random.Generator
) -> list[Delivery]:
    """With a share of the frames that arrive late by up to so many s, and so out of order."""
    late = (rng.random(len(stream)) < share) * rng.random(len(stream)) * seconds
    moved = [replace(d, due=d.due + float(by)) for d, by in zip(stream, late, strict=True)]
    return sorted(moved, key=lambda delivery: delivery.due)


def swap(stream: Stream, share: float, rng: np.random.Generator) -> list[Delivery]:
    """With a share of the frames that change places with the next one."""
    swapped, i = list(stream), 1
    while i < len(swapped) - 1:
        if rng.random() < share:
            first, second = swapped[i], swapped[i + 1]
            swapped[i], swapped[i + 1] = (
                replace(second, due=first.due),
                replace(first, due=second.due),
            )
            i += 1
        i += 1
    return swapped


def freeze(stream: Stream, first: int, last: int) -> list[Delivery]:
    """With the stamp of frame ``first`` in all that follow, up to ``last``."""
    stamp = stream[first].stamp
    return restamp(stream, first, last, lambda _: stamp)


def shift(stream: Stream, first: int, seconds: float) -> list[Delivery]:
    """With stamps from frame ``first`` on that are off by so many s: another clock."""
    return restamp(stream, first, len(stream), lambda stamp: stamp + round(seconds * SECOND))


def restamp(stream: Stream, first: int, last: int, change: Callable[[int], int]) -> list[Delivery]:
    """With changed stamps in the deliveries first..last-1."""
    return [
        replace(d, stamp=change(d.stamp)) if first <= i < last else d for i, d in enumerate(stream)
    ]
