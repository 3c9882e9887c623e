# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tracker in a process of its own that works when it is its turn.

What crashes in native code takes its own process down and nothing else.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import time
from collections.abc import Iterator
from multiprocessing.connection import Connection

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.sequences import Frames
from het_ros.evaluation.trackers import Identity, Tracker, TrackerSpec
from het_ros.tracking.box import Box

# A forked process would share locks and threads that OpenCV and BLAS hold at that moment.
_SPAWN = multiprocessing.get_context("spawn")
PATIENCE = 5.0  # s that a process has to end after it was told to


class Player:
    """One tracker's process. It is started when it is needed, and anew when it died.

    Args:
        spec: the tracker; it must be picklable.
    """

    def __init__(self, spec: TrackerSpec) -> None:
        self._spec = spec
        self._process: multiprocessing.process.BaseProcess | None = None
        self._pipe: Connection | None = None

    def start(self, frames: Frames, box: Box) -> bool:
        """Start the tracker on the first of some frames; False when it raised or died."""
        if self._process is None:
            self._pipe, theirs = _SPAWN.Pipe()
            self._process = _SPAWN.Process(target=_serve, args=(self._spec, theirs), daemon=True)
            self._process.start()
            theirs.close()  # else its death would not be the pipe's end
        return bool(self._asked((frames, box)))

    def times(self, rows: range) -> list[float]:
        """Let it follow into some frames: the times of ``update``, s, up to where it failed."""
        return list(self._asked(rows) or ())

    def close(self) -> None:
        """End the process."""
        if self._pipe is not None:
            self._pipe.close()
        if self._process is not None:
            self._process.join(PATIENCE)
            self._process.kill()
            self._process.join()
        self._process = self._pipe = None

    def _asked(self, request: tuple[Frames, Box] | range) -> bool | list[float] | None:
        """The process's answer; None when it died."""
        if self._pipe is None:
            return None
        try:
            self._pipe.send(request)
            answer: bool | list[float] = self._pipe.recv()
        except (EOFError, OSError):
            self.close()
            return None
        return answer


@contextlib.contextmanager
def players(specs: list[TrackerSpec]) -> Iterator[list[Player]]:
    """A player for each tracker; their processes end with the context."""
    made = [Player(spec) for spec in specs]
    try:
        yield made
    finally:
        for player in made:
            player.close()


def _serve(spec: TrackerSpec, pipe: Connection) -> None:
    """Answer requests until the pipe is closed; whatever a tracker raises is its failure."""
    frames = Frames(())
    tracker: Tracker = Identity()
    with one_thread(), contextlib.suppress(EOFError, KeyboardInterrupt):
        while True:
            request = pipe.recv()
            if isinstance(request, range):
                images = [frames[row] for row in request]
                pipe.send(_timed(tracker, images, frames.dt))
                continue
            frames, box = request
            try:
                tracker = spec.build(0)
                tracker.init(frames[0], box)
                pipe.send(True)
            except Exception:  # the scored runs record what it died of
                pipe.send(False)


def _timed(tracker: Tracker, images: list[NDArray[np.uint8]], dt: float) -> list[float]:
    """Times of the updates, s, up to where it raises."""
    times: list[float] = []
    for image in images:
        begun = time.perf_counter()
        try:
            tracker.update(image, dt)
        except Exception:  # as above
            break
        times.append(time.perf_counter() - begun)
    return times
