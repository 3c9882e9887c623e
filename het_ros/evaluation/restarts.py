# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Accuracy and robustness of the restart protocol, as VOT defines them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.metrics import overlaps
from het_ros.evaluation.protocols import BURN_IN
from het_ros.evaluation.runs import Run

RELIABILITY_FRAMES = 100  # VOT's S: a chance of surviving that many frames


def summarise(runs: Iterable[Run], truths: Mapping[str, NDArray[np.float64]]) -> dict[str, Any]:
    """Means over all runs.

    Returns:
        ``accuracy``: mean overlap while tracking, without the first frames after each start;
        ``failures``: failures a run; ``failures_per_100``: a hundred frames; ``reliability``:
        exp(-100 failures / frames), the chance to survive 100 frames.
    """
    accuracies, failures, rates = [], [], []
    for run in runs:
        overlap = overlaps(run.track.boxes, truths[run.sequence])
        for start in run.track.starts:
            overlap[start : start + BURN_IN] = np.nan
        if np.isfinite(overlap).any():
            accuracies.append(np.nanmean(overlap))
        failures.append(len(run.track.failures))
        rates.append(len(run.track.failures) / len(run.track.boxes))
    return {
        "accuracy": float(np.mean(accuracies)) if accuracies else None,
        "failures": float(np.mean(failures)),
        "failures_per_100": float(100 * np.mean(rates)),
        "reliability": float(np.mean(np.exp(-RELIABILITY_FRAMES * np.array(rates)))),
    }
