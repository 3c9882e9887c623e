# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a tracker says of one frame, and of a whole run."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

NAN2 = (float("nan"), float("nan"))
HORIZONS = (0.1, 0.2, 0.5)  # s ahead, for which a tracker's own prediction is recorded


@dataclass(frozen=True)
class Answer:
    """One frame's answer. A tracker that cannot say something leaves it out.

    Attributes:
        box: x, y, w, h, px, counted from 0; None: no box (the one before is kept).
        state: "TRACKING", "COASTING", "LOST", or "" when the tracker has no states.
        score: 0..1, or NaN.
        velocity: of the centre, px/s.
        covariance: (4, 4) of [cx, cy, vx, vy], or None.
        predictions: (3, 2) centres px, ``HORIZONS`` ahead, or None.
    """

    box: tuple[float, float, float, float] | None
    state: str = ""
    score: float = float("nan")
    velocity: tuple[float, float] = NAN2
    covariance: NDArray[np.float64] | None = None
    predictions: NDArray[np.float64] | None = None


@dataclass
class Track:
    """One run: an answer a frame, in arrays of n rows.

    Attributes:
        boxes: (n, 4) float64 x, y, w, h, px.
        states: (n,) str.
        scores: (n,) float64, NaN where the tracker gave none.
        velocities: (n, 2) float64, px/s.
        covariances: (n, 2, 2) float64 of the centre, px^2.
        velocity_covariances: (n, 2, 2) float64 of the velocity, px^2/s^2.
        predictions: (n, 3, 2) float64 centres, px, ``HORIZONS`` ahead.
        seconds: (n,) float64, time of ``update`` (``init`` in row 0), s; NaN where it was not
            called.
        starts: frames at which the tracker was started; more than one after restarts.
        failures: frames at which the restart protocol saw the target lost.
        error: what the tracker died of, or "".
    """

    boxes: NDArray[np.float64]
    states: NDArray[np.str_]
    scores: NDArray[np.float64]
    velocities: NDArray[np.float64]
    covariances: NDArray[np.float64]
    velocity_covariances: NDArray[np.float64]
    predictions: NDArray[np.float64]
    seconds: NDArray[np.float64]
    starts: list[int] = field(default_factory=lambda: [0])
    failures: list[int] = field(default_factory=list)
    error: str = ""

    @classmethod
    def empty(cls, n: int, error: str = "") -> Track:
        """A run of which nothing is known yet."""
        return cls(
            boxes=np.full((n, 4), np.nan),
            states=np.full(n, "", dtype="<U8"),
            scores=np.full(n, np.nan),
            velocities=np.full((n, 2), np.nan),
            covariances=np.full((n, 2, 2), np.nan),
            velocity_covariances=np.full((n, 2, 2), np.nan),
            predictions=np.full((n, len(HORIZONS), 2), np.nan),
            seconds=np.full(n, np.nan),
            error=error,
        )

    def put(self, row: int, answer: Answer) -> None:
        """Record one answer; without a box the row before is repeated."""
        self.boxes[row] = self.boxes[row - 1] if answer.box is None else answer.box
        self.states[row] = answer.state
        self.scores[row] = answer.score
        self.velocities[row] = answer.velocity
        if answer.covariance is not None:
            whole = np.asarray(answer.covariance)
            self.covariances[row] = whole[:2, :2]
            self.velocity_covariances[row] = whole[2:4, 2:4]
        if answer.predictions is not None:
            self.predictions[row] = answer.predictions

    def repeat(self, row: int) -> None:
        """Record that frame ``row`` got the answer of the frame before."""
        for rows in (
            *(self.boxes, self.states, self.scores, self.velocities),
            *(self.covariances, self.velocity_covariances, self.predictions),
        ):
            rows[row] = rows[row - 1]
