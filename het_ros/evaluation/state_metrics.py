# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Did the tracker know? Its state, its score and its covariance against the truth."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.forewarning import forewarning
from het_ros.evaluation.metrics import ON_TARGET, overlaps
from het_ros.evaluation.runs import Run
from het_ros.evaluation.velocity_metrics import CHI2_95

SCORE_BINS = 10

Truths = Mapping[str, NDArray[np.float64]]


def summarise(runs: list[Run], truths: Truths) -> dict[str, Any]:
    """``state``, ``calibration``, ``forewarning`` and ``nis``, where the tracker speaks of it."""
    found: dict[str, Any] = {}
    pairs = [(run, truths[run.sequence][run.rows]) for run in runs]
    speaking = [(run, truth) for run, truth in pairs if (run.track.states[1:] != "").any()]
    if speaking:
        found["state"] = state(speaking)
    scored = [(run, truth) for run, truth in pairs if np.isfinite(run.track.scores).any()]
    if scored:
        found["calibration"] = calibration(scored)
        found["forewarning"] = forewarning(scored)
    known = [(run, truth) for run, truth in pairs if np.isfinite(run.track.covariances).any()]
    if known:
        found["nis"] = consistency(known)
    return found


Pairs = Iterable[tuple[Run, NDArray[np.float64]]]


def state(pairs: Pairs) -> dict[str, Any]:
    """How well the state tells whether the target is visible, over all frames but the first.

    ``precision``, ``recall`` and ``f`` are those of TRACKING as an answer to "is the target
    visible?". ``false_lost``: frames of LOST though it was visible, and the longest row of
    them; ``missed_lost``: frames of TRACKING though it was absent; ``off_target``: share of
    TRACKING frames whose box does not even touch the visible target; ``reacquisition``: for
    each time the target came back, the frames until TRACKING with an overlap over 0.5 (None:
    not before it left again, or the end).
    """
    said, visible, lost, off = [], [], [], []
    longest, back = 0, []
    for run, truth in pairs:
        states, seen = run.track.states[1:], np.asarray(~np.isnan(truth[1:]).any(axis=1))
        overlap = np.nan_to_num(overlaps(run.track.boxes, truth)[1:])
        tracking = states == "TRACKING"
        false_lost = (states == "LOST") & seen
        said.append(tracking)
        visible.append(seen)
        lost.append(false_lost)
        off.append(tracking & seen & (overlap <= 0))
        longest = max(longest, longest_row(false_lost))
        back += reacquisitions(seen, tracking & (overlap > ON_TARGET))
    yes, truly = np.concatenate(said), np.concatenate(visible)
    right = int((yes & truly).sum())
    precision = right / max(int(yes.sum()), 1)
    recall = right / max(int(truly.sum()), 1)
    in_time = [frames for frames in back if frames is not None]
    return {
        "precision": precision,
        "recall": recall,
        "f": 2 * precision * recall / max(precision + recall, 1e-9),
        "visible_frames": int(truly.sum()),
        "absent_frames": int((~truly).sum()),
        "false_lost": int(np.concatenate(lost).sum()),
        "longest_false_lost": longest,
        "missed_lost": int((yes & ~truly).sum()),
        "off_target": int(np.concatenate(off).sum()) / max(int(yes.sum()), 1),
        "reappearances": len(back),
        "reacquired": len(in_time),
        "reacquisition_frames": float(np.median(in_time)) if in_time else None,
    }


def longest_row(flags: NDArray[np.bool_]) -> int:
    """Length of the longest row of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def reacquisitions(seen: NDArray[np.bool_], right: NDArray[np.bool_]) -> list[int | None]:
    """Frames from each reappearance to the first right frame before the next absence."""
    found: list[int | None] = []
    for first in np.flatnonzero(seen[1:] & ~seen[:-1]) + 1:
        gone = np.flatnonzero(~seen[first:])
        last = first + gone[0] if len(gone) else len(seen)
        hits = np.flatnonzero(right[first:last])
        found.append(int(hits[0]) if len(hits) else None)
    return found


def calibration(pairs: Pairs) -> dict[str, Any]:
    """Score against the share of frames with an overlap over 0.5, in 10 bins of the score.

    A frame with the target absent counts as wrong. ``error`` is the mean distance of the bins
    from the diagonal, weighted by their frames (expected calibration error);
    ``confident_elsewhere`` the frames with a score over 0.5 and no overlap at all.
    """
    scores = np.concatenate([run.track.scores[1:] for run, _ in pairs])
    overlap = np.concatenate(
        [np.nan_to_num(overlaps(run.track.boxes, truth)[1:]) for run, truth in pairs]
    )
    known = np.isfinite(scores)
    scores, overlap = scores[known], overlap[known]
    right = overlap > ON_TARGET
    bins = np.minimum((scores * SCORE_BINS).astype(int), SCORE_BINS - 1)
    rows = []
    for index in range(SCORE_BINS):
        inside = bins == index
        if inside.any():
            rows.append(
                {
                    "score": float(scores[inside].mean()),
                    "right": float(right[inside].mean()),
                    "frames": int(inside.sum()),
                }
            )
    weights = np.array([row["frames"] for row in rows]) / max(len(scores), 1)
    gaps = np.array([abs(row["score"] - row["right"]) for row in rows])
    return {
        "bins": rows,
        "error": float((weights * gaps).sum()),
        "confident_elsewhere": int(((scores > 0.5) & (overlap <= 0)).sum()),
        "frames": len(scores),
    }


def consistency(pairs: Pairs) -> dict[str, Any]:
    """Normalised squared error of the centre with the truth as the measurement.

    NIS = e' P^-1 e, e the error of the centre (px) and P its covariance, over the frames whose
    box touches the target (a lost target says nothing of the filter). A consistent filter has a
    mean of 2 and 95 % of the frames under 5.99.
    """
    values = []
    for run, truth in pairs:
        boxes, covariances = run.track.boxes[1:], run.track.covariances[1:]
        on_target = np.nan_to_num(overlaps(boxes, truth[1:])) > 0
        usable = on_target & (np.linalg.det(np.nan_to_num(covariances)) > 0)
        error = (boxes - truth[1:])[usable]
        error = error[:, :2] + error[:, 2:] / 2
        solved = np.linalg.solve(covariances[usable], error[:, :, None])[:, :, 0]
        values.append((error * solved).sum(axis=1))
    nis = np.concatenate(values)
    if not len(nis):
        return {"frames": 0, "mean": None, "median": None, "within_95": None}
    return {
        "frames": len(nis),
        "mean": float(nis.mean()),
        "median": float(np.median(nis)),
        "within_95": float((nis <= CHI2_95).mean()),
    }
