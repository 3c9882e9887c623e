# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How fast trackers are: alone on the machine, on one thread, taking turns on the same frames."""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Mapping
from collections.abc import Sequence as Listing
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from het_ros.evaluation.cache import key_of
from het_ros.evaluation.sequences import Frames, Sequence
from het_ros.evaluation.trackers import TrackerSpec
from het_ros.evaluation.turns import Player, players
from het_ros.tracking.box import Box

BLOCK = 10  # frames that a tracker gets in a row, with its caches warm


@dataclass(frozen=True)
class Timing:
    """What was measured.

    Attributes:
        seconds: time of each ``update``, s, by (tracker, sequence); NaN where it failed.
        load: highest load average of the machine when a sequence's timing began. Well over 1
            says that other processes took their share, and that the figures are too low.
        frames: updates timed at most on a sequence; 0: nothing was timed.
    """

    seconds: Mapping[tuple[str, str], NDArray[np.float64]] = field(default_factory=dict)
    load: float = 0.0
    frames: int = 0


def time_trackers(
    trackers: Listing[TrackerSpec],
    sequences: Listing[Sequence],
    frames: int,
    folder: Path,
    skipped: Collection[tuple[str, str]] = (),
    quiet: bool = False,
) -> Timing:
    """Time the first ``frames`` updates of every tracker on every sequence.

    All trackers of a comparison are timed together or not at all: what is kept in ``folder`` is
    kept for the whole list of trackers, so that no ratio compares two days. Each tracker runs in
    a process of its own; one that dies takes no other along, and is started again for the next
    sequence. Pairs (tracker, sequence) in ``skipped`` are not run: those whose process died when
    they were scored.
    """
    folder.mkdir(parents=True, exist_ok=True)
    seconds, load = {}, 0.0
    comparison = [tracker.fingerprint for tracker in trackers]
    bar = tqdm(sequences, unit="sequence", desc="timing", disable=quiet)
    with players(list(trackers)) as processes, bar:
        for sequence in bar:
            pairs = zip(trackers, processes, strict=True)
            taken = [p if (t.name, sequence.name) not in skipped else None for t, p in pairs]
            key = key_of(comparison, sequence.frames.fingerprint(), frames)
            file = folder / f"{sequence.name}_{key}.json"
            if not file.is_file():
                part = Frames(sequence.frames.files[: frames + 1], sequence.frames.rate)
                begun = os.getloadavg()[0]
                times = _interleaved(taken, part, Box(*sequence.truth[0]))
                file.write_text(json.dumps({"load": begun, "seconds": [list(t) for t in times]}))
            saved = json.loads(file.read_text())
            load = max(load, saved["load"])
            for tracker, times in zip(trackers, saved["seconds"], strict=True):
                seconds[tracker.name, sequence.name] = np.array(times)
    return Timing(seconds, load, frames)


def _interleaved(
    trackers: Listing[Player | None], frames: Frames, box: Box
) -> list[NDArray[np.float64]]:
    """Blocks of frames in turn: each tracker does one block, then the next tracker does it.

    Returns:
        For each tracker the times of ``update``, s; NaN from where it failed.
    """
    times = [np.full(len(frames) - 1, np.nan) for _ in trackers]
    # One after the other: a network that is read takes the processor from what is timed.
    following = [
        tracker if tracker and tracker.start(frames, box) else None for tracker in trackers
    ]
    for first in range(1, len(frames), BLOCK):
        block = range(first, min(first + BLOCK, len(frames)))
        for k, tracker in enumerate(following):
            if tracker is None:
                continue
            took = tracker.times(block)
            times[k][first - 1 : first - 1 + len(took)] = took
            if len(took) < len(block):
                following[k] = None
    return times
