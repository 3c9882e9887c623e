# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Plan the jobs of a protocol, take from the cache what is there, run the rest."""

from __future__ import annotations

from collections.abc import Sequence as Listing
from dataclasses import dataclass

from tqdm import tqdm

from het_ros.evaluation.answers import Track
from het_ros.evaluation.cache import Cache, key_of
from het_ros.evaluation.jobs import Job, carry_out
from het_ros.evaluation.protocols import Start, starts
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.trackers import TrackerSpec

FROM_THE_START = slice(0, None, 1)


@dataclass(frozen=True)
class Run:
    """A finished run with what identifies it.

    Attributes:
        tracker, sequence: their names.
        seed: the seed.
        variant: the start's name.
        rows: the frames of the sequence, in the run's order.
        track: what the tracker said, one row for each of these.
        camera: frames/s in real time, or None.
    """

    tracker: str
    sequence: str
    seed: int
    variant: str
    rows: slice
    track: Track
    camera: float | None = None


@dataclass(frozen=True)
class Plan:
    """What is to be run.

    Attributes:
        trackers, sequences: all combinations are run.
        protocol: one of ``protocols.PROTOCOLS``.
        seeds: number of seeds of the trackers that are random; the others run once.
        cameras: frames/s of the real-time protocol.
    """

    trackers: Listing[TrackerSpec]
    sequences: Listing[Sequence]
    protocol: str = "ope"
    seeds: int = 1
    cameras: tuple[float, ...] = (20.0, 30.0, 60.0)

    def jobs(self) -> list[tuple[Job, slice]]:
        """Every job with its frames; sequence by sequence, trackers side by side."""
        cameras = self.cameras if self.protocol == "realtime" else (None,)
        return [
            (self._job(sequence, images, start, tracker, seed, camera), start.rows)
            for sequence in self.sequences
            for images in (sequence.frames.fingerprint(),)
            for start in starts(self.protocol, sequence)
            for tracker in self.trackers
            for seed in range(self.seeds if tracker.random else 1)
            for camera in cameras
        ]

    def _job(
        self,
        sequence: Sequence,
        images: str,
        start: Start,
        tracker: TrackerSpec,
        seed: int,
        camera: float | None,
    ) -> Job:
        referee = sequence.truth if self.protocol == "restart" else None
        judged = None if referee is None else referee.tobytes()
        key = key_of(tracker.fingerprint, images, start, seed, camera, judged)
        variant = start.variant if camera is None else f"{start.variant}{camera:g}"
        name = f"{tracker.folder}/{sequence.name}/{variant}_{seed}_{key}"
        return Job(
            tracker=tracker,
            sequence=sequence.name,
            frames=sequence.frames.taken(start.rows),
            box=start.box,
            seed=seed,
            variant=variant,
            key=name,
            camera=camera,
            referee=referee,
        )


def carry_out_plan(
    plan: Plan, cache: Cache, workers: int = 1, scheduler: str = "", quiet: bool = False
) -> list[Run]:
    """Run a plan, each result saved as soon as it is there.

    Real time is measured with one job at a time and never on a cluster.
    """
    planned = plan.jobs()
    loaded = {job.key: cache.load(job.key) for job, _ in planned}
    tracks = {key: track for key, track in loaded.items() if track is not None}
    todo = [job for job, _ in planned if job.key not in tracks]
    if plan.protocol == "realtime":
        workers, scheduler = 1, ""
    frames = sum(len(job.frames) for job, _ in planned)
    ready = frames - sum(len(job.frames) for job in todo)
    with tqdm(total=frames, initial=ready, unit="frame", disable=quiet, smoothing=0.05) as bar:
        for job, track in carry_out(todo, workers, scheduler) if todo else ():
            cache.save(job.key, track)
            tracks[job.key] = track
            bar.set_postfix_str(f"{job.tracker.name} {job.sequence}")
            bar.update(len(job.frames))
    return [_run(job, rows, tracks[job.key]) for job, rows in planned]


def _run(job: Job, rows: slice, track: Track) -> Run:
    return Run(
        tracker=job.tracker.name,
        sequence=job.sequence,
        seed=job.seed,
        variant=job.variant,
        rows=rows,
        track=track,
        camera=job.camera,
    )
