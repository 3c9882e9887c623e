# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""track.csv: what the tracker answered to each frame, one row a frame."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import State

COLUMNS = ("stamp", "x", "y", "w", "h", "vx", "vy", "score", "state")


@dataclass(frozen=True)
class Row:
    """The answer to one frame.

    Attributes:
        stamp: header stamp of the frame, ns.
        box: filtered box, px; None while nothing is followed (IDLE, LOST) or without an answer.
        velocity: (vx, vy) of its centre, px/s; None like the box.
        score: 0..1; None without an answer.
        state: None if no answer came to this frame.
        velocity_deviation: of each part of the velocity, px/s; not in the file.
    """

    stamp: int
    box: Box | None = None
    velocity: tuple[float, float] | None = None
    score: float | None = None
    state: State | None = None
    velocity_deviation: float | None = field(default=None, compare=False)


def write_csv(rows: Iterable[Row], path: Path | str) -> None:
    """Write rows as ``stamp,x,y,w,h,vx,vy,score,state``; what is unknown stays empty.

    The stamp is in s with all nine decimals, boxes in px, velocities in px/s.
    """
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(_fields(row) for row in rows)


def read_csv(path: Path | str) -> list[Row]:
    """Read what :func:`write_csv` wrote.

    Raises:
        ValueError: the file has other columns.
    """
    with Path(path).open(newline="", encoding="utf-8") as file:
        reader = csv.reader(file)
        if tuple(next(reader, ())) != COLUMNS:
            raise ValueError(f"{path} is no track.csv: its columns are not {','.join(COLUMNS)}")
        return [_row(fields) for fields in reader]


def _fields(row: Row) -> list[str]:
    seconds, nanoseconds = divmod(row.stamp, 10**9)
    numbers = [*(row.box.as_tuple() if row.box else [None] * 4), *(row.velocity or [None] * 2)]
    texts = ["" if number is None else f"{number:.3f}" for number in numbers]
    score = "" if row.score is None else f"{row.score:.4f}"
    state = row.state.value if row.state else ""
    return [f"{seconds}.{nanoseconds:09d}", *texts, score, state]


def _row(fields: list[str]) -> Row:
    stamp, *numbers, score, state = fields
    seconds, _, nanoseconds = stamp.partition(".")
    x, y, w, h, vx, vy = (float(text) if text else None for text in numbers)
    return Row(
        int(seconds) * 10**9 + int(nanoseconds),
        Box(x, y, w, h) if None not in (x, y, w, h) else None,
        (vx, vy) if None not in (vx, vy) else None,
        float(score) if score else None,
        State(state) if state else None,
    )
