"""One run as a job that can be sent away, and how many of them are carried out."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
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
    failed run, the others are run again.
    """
    if scheduler:
        with cluster.connected(scheduler):
            yield from _stream(jobs, pre_dispatch="all")
        return
    left = {job.key: job for job in jobs}
    try:
        with _processes(workers):
            for job, track in _stream(jobs, pre_dispatch=workers):
                del left[job.key]
                yield job, track
    except TerminatedWorkerError:
        for job in left.values():
            yield job, _alone(job)


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


def _stream(jobs: list[Job], pre_dispatch: int | str) -> Iterator[tuple[Job, Track]]:
    parallel = joblib.Parallel(
        return_as="generator_unordered", batch_size=1, pre_dispatch=pre_dispatch
    )
    for index, track in parallel(joblib.delayed(_numbered)(i, j) for i, j in enumerate(jobs)):
        yield jobs[index], track


def _numbered(index: int, job: Job) -> tuple[int, Track]:
    return index, run_job(job)


def _alone(job: Job) -> Track:
    """Run a job in a process of its own, which may die."""
    try:
        with _processes(1):
            return next(_stream([job], pre_dispatch=1))[1]
    except TerminatedWorkerError:
        return _failed(job, "the process died (a crash in native code)")


def _failed(job: Job, error: str) -> Track:
    """A run that never came to an answer: its start's box stays, for the scorer."""
    track = Track.empty(len(job.frames), error)
    track.boxes[:] = job.box.as_tuple()
    return track
