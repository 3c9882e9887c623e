# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From runs to the figures of ``results.json``: means over seeds, starts and sequences."""

from __future__ import annotations

import dataclasses
import datetime
import os
import platform
from collections import defaultdict
from collections.abc import Iterable, Mapping
from collections.abc import Sequence as Listing
from typing import Any

import cv2
import numpy as np

from het_ros.evaluation import groups, honesty, restarts, state_metrics, velocity
from het_ros.evaluation.metrics import Score, score
from het_ros.evaluation.runs import Plan, Run
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.timing import Timing

FIGURES = ("auc", "p20", "norm_precision", "mean_overlap")


@dataclasses.dataclass(frozen=True)
class Scored:
    """A run with its score."""

    run: Run
    score: Score


def score_runs(runs: Iterable[Run], sequences: Listing[Sequence]) -> list[Scored]:
    """Score every run against the truth of its sequence."""
    truth = {sequence.name: sequence.truth for sequence in sequences}
    return [Scored(run, score(run.track.boxes, truth[run.sequence][run.rows])) for run in runs]


def summarise(plan: Plan, scored: Listing[Scored], timing: Timing) -> dict[str, Any]:
    """The content of ``results.json``.

    A random tracker's figures are means over its seeds; ``*_std`` is the sample standard
    deviation of the seeds' means over the sequences, and ``groups`` holds the means over all and
    by group of sequences with their standard errors over sequences. AUC and precision of a
    tracker are means over sequences, each sequence counting the same, as in OTB.
    """
    sequences = {sequence.name: sequence for sequence in plan.sequences}
    trackers = {}
    for spec in plan.trackers:
        own = [s for s in scored if s.run.tracker == spec.name]
        trackers[spec.name] = _tracker(plan, spec.name, own, sequences, timing)
    return {
        "protocol": plan.protocol,
        "date": datetime.date.today().isoformat(),
        "seeds": plan.seeds,
        "machine": machine(),
        "timing": {"frames": timing.frames, "load": timing.load},
        "sequences": list(sequences),
        "trackers": trackers,
    }


def _tracker(
    plan: Plan,
    name: str,
    own: list[Scored],
    sequences: Mapping[str, Sequence],
    timing: Timing,
) -> dict[str, Any]:
    if plan.protocol == "realtime":
        main = 30.0 if 30.0 in plan.cameras else plan.cameras[0]
        rates = {f"{c:g}": _rate([s for s in own if s.run.camera == c]) for c in plan.cameras}
        own = [s for s in own if s.run.camera == main]
    by_sequence = _grouped(own, lambda s: s.run.sequence)
    figures: dict[str, Any] = {}
    for figure in FIGURES:
        mean, deviation = mean_and_deviation(own, figure)
        figures[figure] = mean
        figures[f"{figure}_std"] = deviation
    figures["groups"] = _groups(by_sequence)
    figures |= speed(_times(name, own, timing))
    figures["seeds"] = len({s.run.seed for s in own})
    figures["errors"] = [
        {"sequence": s.run.sequence, "seed": s.run.seed, "start": s.run.variant, "error": e}
        for s in own
        if (e := s.run.track.error)
    ]
    figures["success_curve"] = _curve(by_sequence, "success")
    figures["precision_curve"] = _curve(by_sequence, "precision")
    figures["sequences"] = {
        sequence: _sequence(name, group, timing) for sequence, group in by_sequence.items()
    }
    figures["attributes"] = _attributes(figures["sequences"], sequences)
    truths = {sequence.name: sequence.truth for sequence in sequences.values()}
    runs = [s.run for s in own]
    figures |= state_metrics.summarise(runs, truths) | honesty.summarise(runs, truths)
    if plan.protocol == "realtime":
        figures["realtime"] = rates
    if plan.protocol == "restart":
        figures |= restarts.summarise(runs, truths)
    else:
        frames = {sequence.name: sequence.frames for sequence in sequences.values()}
        figures |= velocity.summarise(runs, truths, frames)
    return figures


def _groups(by_sequence: Mapping[str, list[Scored]]) -> dict[str, Any]:
    """By figure and group: the mean over sequences, its standard error, and how many they are."""
    return {
        figure: {
            group: {"mean": m.value, "standard_error": m.error, "sequences": m.count}
            for group, m in groups.means(
                {name: mean_and_deviation(of, figure)[0] for name, of in by_sequence.items()}
            ).items()
        }
        for figure in FIGURES
    }


def _sequence(name: str, group: list[Scored], timing: Timing) -> dict[str, Any]:
    figures: dict[str, Any] = {}
    for figure in FIGURES:
        figures[figure], figures[f"{figure}_std"] = mean_and_deviation(group, figure)
    figures |= speed(_times(name, group, timing))
    figures["frames"] = max(s.score.frames for s in group)
    return figures


def mean_and_deviation(scored: Listing[Scored], figure: str) -> tuple[float, float]:
    """Mean over sequences of the mean over starts, seed by seed; mean and std of the seeds."""
    by_seed = []
    for group in _grouped(scored, lambda s: s.run.seed).values():
        of_sequences = _grouped(group, lambda s: s.run.sequence).values()
        by_seed.append(
            np.mean([np.mean([getattr(s.score, figure) for s in runs]) for runs in of_sequences])
        )
    deviation = float(np.std(by_seed, ddof=1)) if len(by_seed) > 1 else 0.0
    return float(np.mean(by_seed)), deviation


def speed(seconds: np.ndarray) -> dict[str, float | None]:
    """Frames/s from the median, and the 99th percentile in ms, of the times of ``update``."""
    known = seconds[np.isfinite(seconds)]
    if not len(known):
        return {"fps": None, "p99_ms": None}
    return {
        "fps": float(1 / np.median(known)),
        "p99_ms": float(1e3 * np.percentile(known, 99)),
    }


def _times(name: str, own: Listing[Scored], timing: Timing) -> np.ndarray:
    """From the timing runs; where there are none, from the scored ones, which shared the CPU."""
    names = sorted({s.run.sequence for s in own})
    timed = [
        timing.seconds[name, sequence] for sequence in names if (name, sequence) in timing.seconds
    ]
    return np.concatenate(timed or [s.run.track.seconds[1:] for s in own])


def _curve(by_sequence: Mapping[str, list[Scored]], curve: str) -> list[float]:
    means = [np.mean([getattr(s.score, curve) for s in g], axis=0) for g in by_sequence.values()]
    return [round(float(v), 5) for v in np.mean(means, axis=0)]


def _attributes(
    figures: Mapping[str, Mapping[str, Any]], sequences: Mapping[str, Sequence]
) -> dict[str, Any]:
    tagged = defaultdict(list)
    for name in figures:
        for tag in sequences[name].attributes:
            tagged[tag].append(name)
    return {
        tag: {
            "auc": float(np.mean([figures[name]["auc"] for name in names])),
            "p20": float(np.mean([figures[name]["p20"] for name in names])),
            "sequences": len(names),
        }
        for tag, names in sorted(tagged.items())
    }


def _rate(own: list[Scored]) -> dict[str, float]:
    updated = [np.isfinite(s.run.track.seconds).mean() for s in own]
    return {
        "auc": mean_and_deviation(own, "auc")[0],
        "p20": mean_and_deviation(own, "p20")[0],
        "frames_seen": float(np.mean(updated)),
    }


def _grouped(items: Iterable[Any], key: Any) -> dict[Any, list[Any]]:
    groups: dict[Any, list[Any]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def machine() -> dict[str, str]:
    """What the speed depends on."""
    return {
        "cpu": f"{_cpu()}, {os.cpu_count()} processors",
        "system": platform.platform(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "opencv": cv2.__version__,
    }


def _cpu() -> str:
    try:
        with open("/proc/cpuinfo") as listing:  # noqa: PTH123
            for line in listing:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
