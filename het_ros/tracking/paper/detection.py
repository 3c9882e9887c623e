# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Detection: where each base ensemble finds its sub-patch again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.compressive import FeatureMaps

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Detections:
    """Where the sub-patches were found.

    Attributes:
        corners: p (Q, 2) float64, px of the window.
        scores: c (Q,) float64, raw scores there.
    """

    corners: Floats
    scores: Floats


def detect(scores: FeatureMaps, corners: Floats, radius: float) -> Detections:
    """Find each sub-patch at its best place within ``radius``, eq. (7) "classification".

    The N samples of the paper are all places of the disc. Of equal scores the one nearest the
    centre counts, so that a target in front of nothing stays where it is.

    Args:
        scores: F (Q, rows, columns) at every px of the window, rows and columns from 0.
        corners: where the sub-patches are looked for (Q, 2), px of the window.
        radius: beta, px; a centre is never without samples.
    """
    distances = squared_distances(corners, scores.shape[1:])
    # The least of a sum of what depends on x alone and on y alone.
    nearest = distances[:, :, :1].min(axis=1) + distances[:, :1].min(axis=2) - distances[:, 0, :1]
    inside = distances < np.maximum(radius**2, nearest + 1e-9)[:, :, None]
    flat = np.where(inside, scores, -np.inf).reshape(len(scores), -1)
    at = flat.argmax(axis=1)
    best = np.take_along_axis(flat, at[:, None], axis=1)
    equal = flat == best
    if np.count_nonzero(equal) > len(equal):
        at = np.where(equal, distances.reshape(flat.shape), np.inf).argmin(axis=1)
    y, x = np.divmod(at, scores.shape[2])
    return Detections(np.stack([x, y], axis=1).astype(np.float64), best[:, 0].astype(np.float64))


def scores_at(scores: FeatureMaps, corners: Floats) -> Floats:
    """Score c (Q,): that of each sub-patch at the place nearest to its corner (Q, 2), px."""
    x, y = nearest_places(corners, scores.shape[1:])
    return np.asarray(scores[np.arange(len(scores)), y, x], np.float64)


def nearest_places(corners: Floats, shape: tuple[int, ...]) -> tuple[Indices, Indices]:
    """Columns (Q,) and rows (Q,) of the places nearest to corners (Q, 2), px.

    Args:
        corners: px; what lies outside is taken to the border.
        shape: (rows, columns) of the places.
    """
    rows, columns = shape
    return (
        np.clip(np.rint(corners[:, 0]).astype(np.intp), 0, columns - 1),
        np.clip(np.rint(corners[:, 1]).astype(np.intp), 0, rows - 1),
    )


def squared_distances(corners: Floats, shape: tuple[int, ...]) -> Floats:
    """(Q, rows, columns): squared distance of each place to each corner (Q, 2), px^2."""
    rows, columns = shape
    dx = np.arange(columns) - corners[:, :1]
    dy = np.arange(rows) - corners[:, 1:]
    return np.asarray(dy[:, :, None] ** 2 + dx[:, None, :] ** 2)
