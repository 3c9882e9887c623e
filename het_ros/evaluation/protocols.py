# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where runs start and how frames reach the tracker: one pass or several, in real time, again."""

from __future__ import annotations

import time
import traceback
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.answers import Track
from het_ros.evaluation.metrics import overlaps
from het_ros.evaluation.sequences import Frames, Sequence
from het_ros.evaluation.trackers import Tracker
from het_ros.tracking.box import Box

PROTOCOLS = ("ope", "tre", "sre", "passes", "half_rate", "realtime", "restart")
TRE_STARTS = 20
RESTART_GAP = 5  # frames from a failure to the new start (VOT)
BURN_IN = 10  # frames after a start that do not count for accuracy (VOT)


@dataclass(frozen=True)
class Start:
    """One start of a protocol.

    Attributes:
        variant: its name in files, e.g. "tre07".
        first: the frame it starts at, counted from 0.
        box: the box given to the tracker, px.
        step: from one frame to the next: 1, or 2 for half the rate, or -1 for backwards.
    """

    variant: str
    first: int
    box: Box
    step: int = field(default=1, repr=False)  # the variant says it: results keep their keys

    @property
    def rows(self) -> slice:
        """The frames of the run, in its order."""
        return slice(self.first, None, self.step)


def starts(protocol: str, sequence: Sequence) -> list[Start]:
    """The starts of a protocol on a sequence: 20 for TRE, 12 for SRE, 5 passes, else 1."""
    if protocol == "tre":
        return _temporal(sequence)
    if protocol == "passes":
        return _passes(sequence)
    box = true_box(sequence, 0)
    if protocol == "sre":
        return [Start(f"sre{k:02d}", 0, b) for k, b in enumerate(disturbed(box))]
    return [Start(protocol, 0, box, 2 if protocol == "half_rate" else 1)]


def _temporal(sequence: Sequence) -> list[Start]:
    """Starts spread evenly in time, each moved on to a frame with a valid box."""
    valid = np.flatnonzero(sequence.visible)
    wanted = np.arange(TRE_STARTS) * len(sequence.frames) // TRE_STARTS
    firsts = sorted({int(valid[valid >= w][0]) for w in wanted if (valid >= w).any()})
    return [Start(f"tre{k:02d}", f, true_box(sequence, f)) for k, f in enumerate(firsts)]


def _passes(sequence: Sequence) -> list[Start]:
    """The same frames in five orders, so that luck in one of them does not decide."""
    count = len(sequence.frames)
    orders = {
        "forwards": slice(0, None, 1),
        "backwards": slice(count - 1, None, -1),
        "from_a_third": slice(count // 3, None, 1),
        "back_from_two_thirds": slice(2 * count // 3 - 1, None, -1),
        "half_rate": slice(0, None, 2),
    }
    passes = []
    for name, order in orders.items():
        visible = np.arange(count)[order][sequence.visible[order]]
        if len(visible):
            first = int(visible[0])
            passes.append(Start(name, first, true_box(sequence, first), order.step))
    return passes


def true_box(sequence: Sequence, frame: int) -> Box:
    """The true box of a frame in which the target is visible."""
    return Box(*(float(value) for value in sequence.truth[frame]))


def disturbed(box: Box) -> list[Box]:
    """OTB's 12: moved by 10 % of the size in 8 directions; 0.8, 0.9, 1.1, 1.2 of the size."""
    (cx, cy), w, h = box.centre, box.w, box.h
    steps = [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)]
    moved = [Box.from_centre(cx + 0.1 * w * sx, cy + 0.1 * h * sy, w, h) for sx, sy in steps]
    return moved + [Box.from_centre(cx, cy, w * s, h * s) for s in (0.8, 0.9, 1.1, 1.2)]


def follow(tracker: Tracker, frames: Frames, box: Box) -> Track:
    """Give a tracker every frame: the plain run of OPE, TRE and SRE.

    A tracker that raises has failed: what it raised is recorded and its last box stays.
    """
    track = Track.empty(len(frames))
    track.boxes[0] = box.as_tuple()
    for row in range(len(frames)):
        if not _step(tracker, frames[row], None if row else box, frames.dt, track, row):
            break
    return _filled(track)


def follow_camera(tracker: Tracker, frames: Frames, box: Box, camera: float) -> Track:
    """Real time: a camera of ``camera`` frames/s does not wait for the tracker.

    The clock is the tracker's own time. A frame that comes while it is busy gets its last
    answer; when it is done it takes the newest frame, or waits for the next.
    """
    track = Track.empty(len(frames))
    track.boxes[0] = box.as_tuple()
    row, free = 0, 0.0  # the frame in hand; when the tracker is done with it, s
    last = 0
    while row < len(frames):
        dt = (row - last) / camera
        if not _step(tracker, frames[row], None if row else box, dt, track, row):
            break
        free = max(free, row / camera) + float(track.seconds[row])
        last, row = row, max(row + 1, int(np.floor(free * camera)))
        for passed in range(last + 1, min(row, len(frames))):
            track.repeat(passed)
    return _filled(track)


def follow_restarting(tracker: Tracker, frames: Frames, truth: NDArray[np.float64]) -> Track:
    """VOT's supervised run: a box that misses the target is a failure, and a new start follows.

    The referee here holds the truth, (n, 4) px; the tracker still gets images and the boxes of
    its starts only. A tracker that raises has failed as well. Rows between a failure and the new
    start stay NaN.
    """
    track = Track.empty(len(frames))
    track.starts = []
    row, begin = 0, True
    while row < len(frames):
        if begin and np.isnan(truth[row]).any():
            row += 1
            continue
        box = Box(*truth[row]) if begin else None
        if begin:
            track.boxes[row] = truth[row]
            track.starts.append(row)
        alive = _step(tracker, frames[row], box, frames.dt, track, row)
        shared = overlaps(track.boxes[row : row + 1], truth[row : row + 1])[0]
        begin = not alive or bool(shared <= 0)  # NaN, an absent target, is no failure
        if begin:
            track.failures.append(row)
            track.boxes[row] = np.nan
            row += RESTART_GAP
        else:
            row += 1
    return track


def _step(
    tracker: Tracker,
    image: NDArray[np.uint8],
    box: Box | None,
    dt: float,
    track: Track,
    row: int,
) -> bool:
    """One timed ``init`` on a box, or ``update`` where there is none; False when it raised."""
    answer = None
    begun = time.perf_counter()
    try:
        if box is not None:
            tracker.init(image, box)
        else:
            answer = tracker.update(image, dt)
    except Exception as error:  # whatever a peer raises is its failure, not the run's end
        reason = traceback.format_exception_only(error)[-1].strip()
        track.error = track.error or f"frame {row}: {reason}"
        return False
    track.seconds[row] = time.perf_counter() - begun
    if answer is not None:
        track.put(row, answer)
    return True


def _filled(track: Track) -> Track:
    """Repeat the last box to the end, so that a dead tracker is scored, not left out."""
    for row in np.flatnonzero(np.isnan(track.boxes).any(axis=1)):
        track.boxes[row] = track.boxes[row - 1]
    return track
