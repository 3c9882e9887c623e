# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Scores of boxes against the ground truth, as the OTB benchmark defines them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

OVERLAP_THRESHOLDS = np.linspace(0, 1, 21)
ERROR_THRESHOLDS = np.arange(51.0)  # px
NORMALISED_THRESHOLDS = np.linspace(0, 0.5, 51)  # of the target's size
ON_TARGET = 0.5  # overlap from which on a box is right
Floats = NDArray[np.float64]


def overlaps(boxes: Floats, truth: Floats) -> Floats:
    """Intersection over union row by row: (n, 4), (n, 4) -> (n,), NaN where a box is NaN."""
    low = np.maximum(boxes[:, :2], truth[:, :2])
    high = np.minimum(boxes[:, :2] + boxes[:, 2:], truth[:, :2] + truth[:, 2:])
    shared = np.clip(high - low, 0, None).prod(axis=1)
    union = boxes[:, 2:].prod(axis=1) + truth[:, 2:].prod(axis=1) - shared
    # Rounding would lift a perfect overlap over the threshold 1 now and then.
    return np.asarray(np.minimum(shared / union, 1.0))


def centre_errors(boxes: Floats, truth: Floats) -> Floats:
    """Distance of the centres row by row, px: (n, 4), (n, 4) -> (n,)."""
    return np.asarray(np.linalg.norm(_centres(boxes) - _centres(truth), axis=1))


def normalised_errors(boxes: Floats, truth: Floats) -> Floats:
    """Distance of the centres in units of the true width and height (TrackingNet): (n,)."""
    apart = (_centres(boxes) - _centres(truth)) / truth[:, 2:]
    return np.asarray(np.linalg.norm(apart, axis=1))


def _centres(boxes: Floats) -> Floats:
    return boxes[:, :2] + boxes[:, 2:] / 2


def success_curve(overlap: Floats) -> Floats:
    """Share of frames whose overlap is over each of the 21 thresholds: (n,) -> (21,).

    An overlap of 1 is not over the threshold 1, so a perfect tracker's mean is 20/21.
    """
    return np.asarray((overlap[:, None] > OVERLAP_THRESHOLDS).mean(axis=0))


def precision_curve(error: Floats, thresholds: Floats = ERROR_THRESHOLDS) -> Floats:
    """Share of frames whose error is at most each threshold: (n,) -> (thresholds,)."""
    return np.asarray((error[:, None] <= thresholds).mean(axis=0))


@dataclass(frozen=True)
class Score:
    """What one run is worth.

    Attributes:
        auc: mean of the success curve.
        p20: share of frames with a centre error of at most 20 px.
        norm_precision: mean of the precision curve over normalised errors from 0 to 0.5.
        mean_overlap: mean overlap.
        frames: frames that were scored: those with a valid true box.
        success, precision: the curves, (21,) and (51,).
        overlap: (n,) overlap by frame, NaN in frames that are not scored.
    """

    auc: float
    p20: float
    norm_precision: float
    mean_overlap: float
    frames: int
    success: Floats
    precision: Floats
    overlap: Floats


def score(boxes: Floats, truth: Floats) -> Score:
    """Score one run; the first frame counts as the ground truth.

    Args:
        boxes: (n, 4) x, y, w, h, px. A row that is no box counts as the one before it.
        truth: (n, 4) px; rows of NaN (no valid box) are left out.

    Raises:
        ValueError: the shapes differ.
    """
    if boxes.shape != truth.shape:
        raise ValueError(f"{len(boxes)} boxes cannot be scored against {len(truth)} true ones")
    boxes = repaired(boxes)
    boxes[0] = truth[0]
    overlap = overlaps(boxes, truth)
    scored = ~np.isnan(overlap)
    success = success_curve(overlap[scored])
    precision = precision_curve(centre_errors(boxes, truth)[scored])
    normalised = precision_curve(normalised_errors(boxes, truth)[scored], NORMALISED_THRESHOLDS)
    return Score(
        auc=float(success.mean()),
        p20=float(precision[20]),
        norm_precision=float(normalised.mean()),
        mean_overlap=float(overlap[scored].mean()),
        frames=int(scored.sum()),
        success=success,
        precision=precision,
        overlap=overlap,
    )


def repaired(boxes: Floats) -> Floats:
    """Copy in which every row that is no box (NaN, or no area) repeats the row before it."""
    boxes = np.array(boxes, np.float64)
    with np.errstate(invalid="ignore"):
        broken = ~(np.isfinite(boxes).all(axis=1) & (boxes[:, 2:] > 0).all(axis=1))
    for row in np.flatnonzero(broken):
        if row:
            boxes[row] = boxes[row - 1]
    return boxes
