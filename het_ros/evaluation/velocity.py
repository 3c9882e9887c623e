# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The published velocities of runs, beside what can be had from their boxes alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from het_ros.evaluation import groups, velocity_metrics
from het_ros.evaluation.answers import HORIZONS, Track
from het_ros.evaluation.metrics import ON_TARGET, overlaps
from het_ros.evaluation.velocity_metrics import Flags, Floats

if TYPE_CHECKING:
    from het_ros.evaluation.runs import Run  # which needs what runs trackers: scenes do not
    from het_ros.evaluation.sequences import Frames

LEAST_FRAMES = 20  # on the target, of a run that is judged
MOVING = 0.5  # sides/s: true speed, root mean square, of a target that moves

Figures = dict[str, Any]


def judge(track: Track, truth: Floats, dt: float, exact: Floats | None = None) -> Figures | None:
    """The figures of one run, in target sides (a second).

    Frames count where the overlap is over 0.5, the state is not LOST (nothing is published then),
    and velocity and truth are known.

    Args:
        track: what the tracker said.
        truth: (n, 4) px of the same frames.
        dt: time between two of them, s.
        exact: (n, 2) px/s, the true velocity where it is known; else the derivative of the truth.

    Returns:
        Root mean square errors: ``zero`` (the true speed itself), ``differences`` of the boxes,
        ``filter`` (constant velocity, on the same boxes) and ``published``; ``change``,
        ``filter_change`` and ``true_change`` from frame to frame, sides/s; ``lag`` and
        ``filter_lag``, frames; ``within_95``; ``ahead`` {horizon: {name: error, sides}};
        ``frames``. None where fewer than 20 frames count.
    """
    true = derivative_of(truth, dt) if exact is None else exact
    use = usable(track, truth) & np.isfinite(true).all(axis=1)
    if use.sum() < LEAST_FRAMES:
        return None
    side = velocity_metrics.sides(truth)[:, None]
    given = np.where((track.states == "LOST")[:, None], np.nan, track.boxes)
    places = velocity_metrics.centres(given)
    start = float(velocity_metrics.sides(track.boxes[:1])[0])
    _, smooth, _ = velocity_metrics.filtered(places, start, dt)
    steps = velocity_metrics.differences(places, dt)
    estimates = {
        "zero": np.zeros_like(true),
        "differences": steps,
        "filter": smooth,
        "published": track.velocities,
    }
    found: Figures = {
        name: velocity_metrics.rms(((velocity - true) / side)[use])
        for name, velocity in estimates.items()
    }
    kinds = {"change": track.velocities, "filter_change": smooth, "true_change": true}
    for name, velocity in kinds.items():
        found[name] = velocity_metrics.rms(velocity_metrics.changes(velocity, use) / side)
    known = np.where(use[:, None], true, np.nan)
    found["lag"] = velocity_metrics.lag(_where(use, track.velocities), known)
    found["filter_lag"] = velocity_metrics.lag(_where(use, smooth), known)
    found["within_95"] = velocity_metrics.share_within(
        (track.velocities - true)[use], track.velocity_covariances[use]
    )
    found["ahead"] = _ahead(track, places, steps, truth, use, dt)
    found["frames"] = int(use.sum())
    return found


def derivative_of(truth: Floats, dt: float) -> Floats:
    """The true velocity from true boxes, px/s."""
    return velocity_metrics.derivative(velocity_metrics.centres(truth), dt)


def usable(track: Track, truth: Floats) -> Flags:
    """Frames on the target with a velocity that is published; the first, which is given, not."""
    on = np.nan_to_num(overlaps(track.boxes, truth)) > ON_TARGET
    on &= (track.states != "LOST") & np.isfinite(track.velocities).all(axis=1)
    on[0] = False
    return np.asarray(on)


def _where(use: Flags, velocities: Floats) -> Floats:
    return np.where(use[:, None], velocities, np.nan)


def _ahead(
    track: Track, places: Floats, steps: Floats, truth: Floats, use: Flags, dt: float
) -> dict[str, dict[str, float | None]]:
    predictors: dict[str, velocity_metrics.Predictor] = {
        "stays": lambda seconds: places,
        "two_boxes": lambda seconds: places + seconds * steps,
        "velocity": lambda seconds: places + seconds * track.velocities,
        "own": lambda seconds: track.predictions[:, HORIZONS.index(seconds)],
    }
    return velocity_metrics.prediction_errors(predictors, truth, use, HORIZONS, dt)


def summarise(
    runs: Iterable[Run], truths: Mapping[str, Floats], frames: Mapping[str, Frames]
) -> dict[str, Any]:
    """``velocity`` by sequence, each figure a mean over its runs; empty without velocities.

    Args:
        runs: of one tracker.
        truths: (n, 4) px by sequence.
        frames: of the whole sequences, by sequence.
    """
    by_sequence: dict[str, list[Figures]] = {}
    for run in runs:
        dt = 1 / run.camera if run.camera else frames[run.sequence].taken(run.rows).dt
        figures = judge(run.track, truths[run.sequence][run.rows], dt)
        if figures is not None:
            by_sequence.setdefault(run.sequence, []).append(figures)
    if not by_sequence:
        return {}
    return {"velocity": {name: groups.averaged(found) for name, found in by_sequence.items()}}


def moving(figures: Mapping[str, Figures]) -> dict[str, Figures]:
    """The sequences whose target moves by more than half a side a second."""
    return {name: found for name, found in figures.items() if found["zero"] > MOVING}
