# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Fit the constants of the score, with a network and without, to recorded tracks.

The tracker follows sequences with ground truth, from their true first boxes and from boxes that
are off by a tenth, and rendered scenes. Each fit is judged by folds that hold a sequence out, and
the constants are written with these figures into one file. While it is recorded, the tracker runs
with the constants that the file names as RECORDED_WITH, so the same data give the same file
however often this is run; --again takes the fitted ones.
"""

from __future__ import annotations

import datetime
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import joblib
import numpy as np
from tqdm import tqdm

from het_ros.evaluation import fitted_file, logistic, network_peers
from het_ros.evaluation import sequences as real
from het_ros.evaluation.fit import (
    WIDTHS,
    Fit,
    Recorded,
    examples,
    fitted,
    frames_of,
    given_boxes,
    groups_of,
    recorded,
)
from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.protocols import true_box
from het_ros.evaluation.readers import add_sequences, read_sequences
from het_ros.scene import Scene, SceneConfig
from het_ros.scene.honesty import IN_SIGHT
from het_ros.tools.arguments import INTERRUPTED, command
from het_ros.tracking import fitted as in_use
from het_ros.tracking.box import Box
from het_ros.tracking.calibration import Calibration
from het_ros.tracking.config import TrackerConfig

EXAMPLE = """examples:
  python -m het_ros.tools.fit --data ../shared/sequences --models ../shared/models
  python -m het_ros.tools.fit --data ../shared/sequences --sequences Crossing,Woman --scenes 0 \\
      --out out/fit/fitted.py
"""
STORIES = ("hidden_1s", "leaves_and_returns", "lookalike_crosses", "lookalike_at_column")
RENDERED = "rendered"  # the group of all scenes: they share street and clothes


@dataclass(frozen=True)
class Job:
    """One run of a tracker.

    Attributes:
        source: what it follows.
        group: what this is held out with.
        config: of the tracker.
        calibration: what it runs with.
        start: the box that is given; None in a scene, which has its own.
    """

    source: real.Sequence | SceneConfig
    group: str
    config: TrackerConfig
    calibration: Calibration
    start: Box | None = None


def run(job: Job) -> Recorded:
    """Carry it out in this process, on one thread."""
    with one_thread():
        source = job.source
        if isinstance(source, SceneConfig):
            return _run_scene(source, job)
        assert job.start is not None
        frames, dt = frames_of(source), source.frames.dt
        return recorded(source.name, job.group, frames, job.start, dt, job.config, job.calibration)


def _run_scene(config: SceneConfig, job: Job) -> Recorded:
    scene = Scene(config)
    start = scene.frame(0).box
    assert start is not None  # every story begins with a visible target

    def frames() -> Iterator[tuple[Any, Box | None]]:
        for frame in scene.frames():
            yield frame.image, frame.box if frame.visible >= IN_SIGHT else None

    name = f"{RENDERED}-{config.story}-{config.seed}"
    return recorded(name, job.group, frames(), start, 1 / config.rate, job.config, job.calibration)


def planned(options: Any, calibration: Calibration) -> list[Job]:
    """Every run that the options ask for, with a network and without.

    Raises:
        ValueError: the data or the networks are not there.
    """
    names = tuple(filter(None, options.sequences.split(",")))
    found = read_sequences(options.data, names)
    networks = [""]
    if options.models:
        files = network_peers.files_of("nanotrack-v3", options.models)
        networks.append(str(files[0].parent))
    groups = groups_of(found)
    jobs = []
    for turn, sequence in enumerate(found):
        starts = given_boxes(true_box(sequence, 0), options.seeds, options.off, turn)
        for seed, box in starts:
            for network in networks:
                config = TrackerConfig(seed=seed, network=network)
                jobs.append(Job(sequence, groups[sequence.name], config, calibration, box))
    for story in STORIES:
        for seed in range(options.scenes):
            scene = SceneConfig(story=story, seed=seed, width=320, height=240, rate=15.0)
            for network in networks:
                config = TrackerConfig(seed=seed, network=network)
                jobs.append(Job(scene, RENDERED, config, calibration))
    return jobs


def carried_out(jobs: Sequence[Job], workers: int, quiet: bool = False) -> list[Recorded]:
    """Run them in other processes."""
    parallel = joblib.Parallel(n_jobs=workers, return_as="generator", pre_dispatch="2*n_jobs")
    results = parallel(joblib.delayed(run)(job) for job in jobs)
    return list(tqdm(results, total=len(jobs), unit="run", disable=quiet))


def sentence(runs: Sequence[Recorded], options: Any) -> str:
    """What was recorded, for the file."""
    names = sorted({run.sequence for run in runs})
    frames = sum(run.frames for run in runs)
    network = "without and with NanoTrack v3" if options.models else "without a network"
    return (
        f"Data: {frames} frames of {len(runs)} runs, {network}, of {len(names)} sequences, each "
        f"from its first true box ({_count(options.seeds, 'seed')}) and from boxes off by a tenth "
        f"({_count(options.off, 'seed')}): {' '.join(names)}."
    )


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def moved(fits: dict[str, Fit], runs: Sequence[Recorded], before: Calibration) -> str:
    """How far the probabilities move from those of the constants before."""
    lines = []
    for name, fit in fits.items():
        features = examples(runs, name).features
        new, old = (
            logistic.probabilities(features, weights)
            for weights in (fit.weights, getattr(before, name))
        )
        away = np.abs(new - old)
        lines.append(
            f"{name}: probabilities move by {away.mean():.3f} in the mean, 95 % of them by at "
            f"most {np.quantile(away, 0.95):.3f}, from those of the constants recorded with"
        )
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    """Command line."""
    p = command("fit", __doc__, EXAMPLE)
    add_sequences(p)
    p.add_argument("--models", type=Path,
                   help="folder with NanoTrack v3; else what needs it stays")  # fmt: skip
    p.add_argument("--seeds", type=int, default=3, help="runs from the true first box (3)")
    p.add_argument("--off", type=int, default=3, help="runs from boxes off by a tenth (3)")
    p.add_argument("--scenes", type=int, default=1, help="rendered scenes of each story (1)")
    p.add_argument("--only", choices=WIDTHS, help="write only these constants (all)")
    p.add_argument("--again", action="store_true",
                   help="record with the fitted constants: one more round")  # fmt: skip
    p.add_argument("--jobs", type=int, default=joblib.cpu_count(), help="processes")
    p.add_argument("--out", type=Path, default=Path(in_use.__file__),
                   help="the file (default: the one in use)")  # fmt: skip
    p.add_argument("--plot", type=Path, help="also draw reliability and ROC here, PNG")
    options = p.parse_args(argv)
    before = in_use.FITTED if options.again else in_use.RECORDED_WITH
    try:
        if options.seeds < 0 or options.off < 0 or options.seeds + options.off < 1:
            raise ValueError("--seeds and --off together must be 1 or more")
        runs = carried_out(planned(options, before), options.jobs)
        fits, missing = fitted(runs)
        fits = {name: fit for name, fit in fits.items() if options.only in (None, name)}
        if not fits:
            raise ValueError(f"nothing can be fitted: {'; '.join(set(missing.values()))}")
    except (ValueError, OSError) as error:
        print(f"fit: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return INTERRUPTED
    for name, reason in missing.items():
        print(f"fit: {name} stays as it is: {reason}", file=sys.stderr)
    report(options, runs, fits, before)
    return 0


def report(
    options: Any, runs: Sequence[Recorded], fits: dict[str, Fit], before: Calibration
) -> None:
    """Print what the fits are worth, and write the file."""
    print(fitted_file.tables(fits))
    print(moved(fits, runs, before))
    constants = fitted_file.taken_over(fits, in_use.FITTED)
    today = datetime.date.today().isoformat()
    content = fitted_file.text(fits, constants, before, sentence(runs, options), today)
    changed = fitted_file.write(options.out, content)
    print(f"{options.out}{'' if changed else ' (as it was)'}")
    if options.plot:
        fitted_file.plot(fits, options.plot)
        print(options.plot)


if __name__ == "__main__":
    sys.exit(main())
