# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How often a tracker's own score is right, for every tracker that gives one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation import groups
from het_ros.evaluation.metrics import overlaps, success_curve
from het_ros.evaluation.runs import Run
from het_ros.evaluation.state_metrics import calibration, longest_row

Floats = NDArray[np.float64]

CONFIDENT = 0.5  # a score above counts as confident
THRESHOLDS = 101  # of the score, at its quantiles over all runs


def summarise(runs: list[Run], truths: Mapping[str, Floats]) -> dict[str, Any]:
    """``honesty`` of one tracker; empty when it gives no score.

    By sequence, each figure the mean over its runs and without the first frame, which is given:
    ``confident`` share of frames with a score over 0.5; ``confident_off`` share of these whose box
    does not touch the target (or that is absent), None without such frames; ``off`` the same as a
    share of all frames; ``recall`` share of frames with the target visible in which it is said to
    be tracked; ``published_auc`` AUC with no box in LOST frames. Over all: ``longest_false_lost``
    frames in a row of LOST though visible, ``calibration_error``, and ``precision``, ``recall``,
    ``f``, ``threshold`` of :func:`long_term`.
    """
    pairs = [(run, truths[run.sequence][run.rows]) for run in runs]
    pairs = [(run, truth) for run, truth in pairs if np.isfinite(run.track.scores[1:]).any()]
    if not pairs:
        return {}
    by_sequence: dict[str, list[dict[str, Any]]] = {}
    for run, truth in pairs:
        by_sequence.setdefault(run.sequence, []).append(of_run(run, truth))
    figures = {name: groups.averaged(found) for name, found in by_sequence.items()}
    longest = max(found["longest_false_lost"] for of in by_sequence.values() for found in of)
    return {
        "honesty": {
            "sequences": figures,
            "longest_false_lost": longest,
            "calibration_error": calibration(pairs)["error"],
            **long_term(pairs),
        }
    }


def of_run(run: Run, truth: Floats) -> dict[str, Any]:
    """The figures of one run, see :func:`summarise`."""
    overlap = np.nan_to_num(overlaps(run.track.boxes, truth)[1:])
    scores, states = run.track.scores[1:], run.track.states[1:]
    visible = ~np.isnan(truth[1:]).any(axis=1)
    with np.errstate(invalid="ignore"):
        confident = scores > CONFIDENT
    # Without states, a score over a half says that the target is there.
    tracked = states == "TRACKING" if (states != "").any() else confident
    lost = states == "LOST"
    off = confident & (overlap <= 0)
    published = np.where(lost, 0.0, overlap)[visible]
    return {
        "confident": float(confident.mean()),
        "confident_off": float(off.sum() / confident.sum()) if confident.any() else None,
        "off": float(off.mean()),
        "recall": float(tracked[visible].mean()) if visible.any() else None,
        "published_auc": float(success_curve(published).mean()) if visible.any() else None,
        "longest_false_lost": longest_row(lost & visible),
    }


def long_term(pairs: list[tuple[Run, Floats]]) -> dict[str, float]:
    """Precision, recall and F at the threshold of the score with the best F.

    As in long-term tracking (Lukezic et al., "Now you see me", 2018; VOT-LT): at a threshold a
    frame has a prediction where its score is at least that (and the state is not LOST). Precision
    is the mean overlap of the frames with a prediction, 0 where the target is absent, and 1
    without any prediction; recall the sum of these overlaps over the frames with the target
    visible. Both are means over sequences, F is their harmonic mean.
    """
    known = np.concatenate([run.track.scores[1:] for run, _ in pairs])
    known = known[np.isfinite(known)]
    levels = np.quantile(known, np.linspace(0, 1, THRESHOLDS), method="higher")
    curves: dict[str, list[Floats]] = {}
    for run, truth in pairs:
        curves.setdefault(run.sequence, []).append(precision_and_recall(run, truth, levels))
    precision, recall = np.mean([np.mean(of, axis=0) for of in curves.values()], axis=0)
    both = precision + recall
    f = np.divide(2 * precision * recall, both, out=np.zeros_like(both), where=both > 0)
    best = int(np.argmax(f))
    return {
        "precision": float(precision[best]),
        "recall": float(recall[best]),
        "f": float(f[best]),
        "threshold": float(levels[best]),
    }


def precision_and_recall(run: Run, truth: Floats, levels: Floats) -> Floats:
    """(2, thresholds) of one run: the rows are precision and recall."""
    overlap = np.nan_to_num(overlaps(run.track.boxes, truth)[1:])
    visible = int((~np.isnan(truth[1:]).any(axis=1)).sum())
    scores = np.where(run.track.states[1:] == "LOST", np.nan, run.track.scores[1:])
    with np.errstate(invalid="ignore"):
        predicted = scores >= levels[:, None]
    count, shared = predicted.sum(axis=1), (predicted * overlap).sum(axis=1)
    precision = np.divide(shared, count, out=np.ones(len(levels)), where=count > 0)
    return np.stack([precision, shared / max(visible, 1)])
