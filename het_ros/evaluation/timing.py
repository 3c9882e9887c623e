"""How fast trackers are: alone on the machine, on one thread, side by side on the same frames."""

from __future__ import annotations

import time
from collections.abc import Sequence as Listing

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from het_ros.evaluation.answers import Track
from het_ros.evaluation.cache import Cache, key_of
from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.sequences import Frames, Sequence
from het_ros.evaluation.trackers import TrackerSpec
from het_ros.tracking.box import Box

BLOCK = 10  # frames that a tracker gets in a row, with its caches warm

Seconds = dict[tuple[str, str], NDArray[np.float64]]


def time_trackers(
    trackers: Listing[TrackerSpec],
    sequences: Listing[Sequence],
    frames: int,
    cache: Cache,
    quiet: bool = False,
) -> Seconds:
    """Time of ``update``, s, by (tracker, sequence): the first ``frames`` updates of each.

    All trackers of a comparison are timed together or not at all: results are kept under the
    whole list of trackers, so that no ratio compares two days.
    """
    seconds: Seconds = {}
    comparison = [tracker.fingerprint for tracker in trackers]
    with tqdm(sequences, unit="sequence", desc="timing", disable=quiet) as bar:
        for sequence in bar:
            key = key_of(comparison, sequence.frames.fingerprint(), frames)
            names = [f"timing/{sequence.name}/{tracker.folder}_{key}" for tracker in trackers]
            saved = [cache.load(name) for name in names]
            if any(track is None for track in saved):
                part = Frames(sequence.frames.files[: frames + 1], sequence.frames.rate)
                saved = _interleaved(trackers, part, Box(*sequence.truth[0]))
                for name, track in zip(names, saved, strict=True):
                    cache.save(name, track)
            for tracker, track in zip(trackers, saved, strict=True):
                seconds[tracker.name, sequence.name] = track.seconds
    return seconds


def _interleaved(trackers: Listing[TrackerSpec], frames: Frames, box: Box) -> list[Track]:
    """Blocks of frames in turn: each tracker does one block, then the next tracker does it."""
    images = [frames[row] for row in range(len(frames))]
    tracks = [Track.empty(len(frames)) for _ in trackers]
    built = []
    with one_thread():
        for spec, track in zip(trackers, tracks, strict=True):
            tracker = spec.build(0)
            built.append(tracker)
            _timed(lambda t=tracker: t.init(images[0], box), track)
        for first in range(1, len(images), BLOCK):
            block = range(first, min(first + BLOCK, len(images)))
            for tracker, track in zip(built, tracks, strict=True):
                for row in block:
                    if not track.error:
                        _timed(lambda t=tracker, i=images[row]: t.update(i, frames.dt), track, row)
    return tracks


def _timed(call, track: Track, row: int | None = None) -> None:
    begun = time.perf_counter()
    try:
        call()
    except Exception as error:  # recorded as a failure by the scored runs
        track.error = str(error) or type(error).__name__
        return
    if row is not None:
        track.seconds[row] = time.perf_counter() - begun
