# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One run as a job that can be sent away, and how many of them are carried out."""

from __future__ import annotations

import contextlib
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import cv2
import joblib
import numpy as np
from joblib.externals.loky.process_executor import TerminatedWorkerError
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from het_ros.evaluation import cluster
from het_ros.evaluation.answers import Track
from het_ros.evaluation.protocols import follow, follow_camera, follow_restarting
from het_ros.evaluation.sequences import Frames
from het_ros.evaluation.trackers import TrackerSpec, tracking_source
from het_ros.tracking.box import Box

DIED = "the process died (a crash in native code)"


@dataclass(frozen=True)
class Job:
    """One tracker, one sequence, one seed, one start. It holds no truth but the start's box.

    Attributes:
        tracker: what runs.
        sequence: the sequence's name.
        frames: its images from the start on.
        box: the box to start from, px.
        seed: the seed.
        variant: the start's name: "ope", "tre07"...
        key: names the result in the cache.
        camera: frames/s in real time, or None.
        referee: (n, 4) true boxes for the restart protocol's referee, or None.
    """

    tracker: TrackerSpec
    sequence: str
    frames: Frames
    box: Box
    seed: int
    variant: str
    key: str
    camera: float | None = None
    referee: NDArray[np.float64] | None = None


class SourceChangedError(RuntimeError):
    """A worker's tracking package is not the one that the run was planned with."""


def run_job(job: Job) -> Track:
    """Run one job in this process, on one thread.

    Raises:
        SourceChangedError: this process holds another source of the tracker.
    """
    if job.tracker.source and job.tracker.source != tracking_source():
        raise SourceChangedError(
            "het_ros/tracking differs from what this run started with: start it again, "
            "and on a cluster install the same version everywhere"
        )
    with one_thread():
        try:
            tracker = job.tracker.build(job.seed)
        except Exception as error:  # as with whatever else a tracker raises
            return _failed(job, f"it cannot be built: {type(error).__name__}: {error}")
        if job.referee is not None:
            return follow_restarting(tracker, job.frames, job.referee)
        if job.camera is not None:
            return follow_camera(tracker, job.frames, job.box, job.camera)
        return follow(tracker, job.frames, job.box)


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Hold OpenCV and BLAS to one thread."""
    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        cv2.setNumThreads(before)


def carry_out(
    jobs: list[Job], workers: int = 1, scheduler: str = ""
) -> Iterator[tuple[Job, Track]]:
    """Run jobs in other processes and hand back each result as it comes, in any order.

    Args:
        jobs: what to run.
        workers: processes on this machine.
        scheduler: address of a Dask scheduler, "tcp://host:8786"; its workers are used instead
            and need the same files under the same paths.

    A process that dies (a crash in native code) takes its job with it: that job comes back as a
    failed run, whatever ran beside it is run again.
    """
    if scheduler:
        with cluster.connected(scheduler):
            yield from _stream(jobs, "all", run_guarded)
        return
    left = {job.key: job for job in jobs}
    with _processes(workers):
        while left:
            try:
                for job, track in _stream(list(left.values()), workers):
                    del left[job.key]
                    yield job, track
            except TerminatedWorkerError:
                yield from _one_by_one(left)


def _one_by_one(left: dict[str, Job]) -> Iterator[tuple[Job, Track]]:
    """Run jobs singly, taking them out of ``left``, up to the one that its process dies of."""
    for key, job in list(left.items()):
        del left[key]
        try:
            yield from _stream([job], 1)
        except TerminatedWorkerError:
            yield job, _failed(job, DIED)
            return


@contextlib.contextmanager
def _processes(workers: int) -> Iterator[None]:
    """Processes that all load the tracker now: what is edited later does not reach this run.

    There are two even for one worker, of which one waits: joblib runs a single one inside this
    process, where a crash would end everything.
    """
    n = max(workers, 2)
    with joblib.parallel_config("loky", n_jobs=n, idle_worker_timeout=24 * 3600):
        joblib.Parallel(batch_size=1)(joblib.delayed(_load)() for _ in range(n))
        yield


def _load() -> None:
    tracking_source()
    time.sleep(0.3)  # long enough for every process to get one


def _stream(
    jobs: list[Job], pre_dispatch: int | str, run: Callable[[Job], Track] = run_job
) -> Iterator[tuple[Job, Track]]:
    parallel = joblib.Parallel(
        return_as="generator_unordered", batch_size=1, pre_dispatch=pre_dispatch
    )
    tasks = (joblib.delayed(_numbered)(i, job, run) for i, job in enumerate(jobs))
    for index, track in parallel(tasks):
        yield jobs[index], track


def _numbered(index: int, job: Job, run: Callable[[Job], Track]) -> tuple[int, Track]:
    return index, run(job)


def run_guarded(job: Job) -> Track:
    """Run a job of a peer in a process of its own, so that its crash leaves a Dask worker alive.

    A worker that dies is started again by Dask, and again, and joblib waits for it for ever.
    """
    if job.tracker.source:
        return run_job(job)
    command = [sys.executable, "-c", f"from {__name__} import run_piped; run_piped()"]
    done = subprocess.run(
        command,
        input=pickle.dumps(job),
        capture_output=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    if done.returncode < 0:
        return _failed(job, DIED)
    if done.returncode:
        raise RuntimeError(done.stderr.decode(errors="replace"))
    track: Track = pickle.loads(done.stdout)
    return track


def run_piped() -> None:
    """Read a job from standard input, run it, and write its track to standard output."""
    job = pickle.load(sys.stdin.buffer)
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what native code prints goes elsewhere
    with out:
        pickle.dump(run_job(job), out)


def _failed(job: Job, error: str) -> Track:
    """A run that never came to an answer: its start's box stays, for the scorer."""
    track = Track.empty(len(job.frames), error)
    track.boxes[:] = job.box.as_tuple()
    return track
