# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How a run went, in a few lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.metrics import Score, score
from het_ros.tools.results import Row
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import State

HIDDEN = 0.1  # a target of which less than this part can be seen counts as hidden
NO_BOX = (np.nan,) * 4


@dataclass(frozen=True)
class Truth:
    """What is known of the target in one frame.

    Attributes:
        box: where it is, px; None where that is not known.
        visible: the part of it that can be seen, 0..1.
    """

    box: Box | None = None
    visible: float = 1.0

    @property
    def hidden(self) -> bool:
        """Whether nobody could see the target."""
        return self.visible < HIDDEN

    @property
    def seen_box(self) -> Box | None:
        """The box, unless the target is hidden: what a tracker can be held to."""
        return None if self.hidden else self.box


@dataclass(frozen=True)
class Summary:
    """How a run went.

    Attributes:
        sent: frames that the tracker was given.
        answered: frames for which it gave a status.
        seconds: time spent in each state, s.
        latencies: from the arrival of a frame to its answer, ms.
        score: against the ground truth of the frames that show the target; None without any.
        hidden: answered frames in which the target is hidden.
        hidden_told: those of them in which the tracker said so: COASTING or LOST.
    """

    sent: int
    answered: int
    seconds: dict[str, float]
    latencies: NDArray[np.float64]
    score: Score | None
    hidden: int
    hidden_told: int

    @property
    def answered_share(self) -> float:
        """Share of frames with an answer, 0..1."""
        return self.answered / self.sent if self.sent else 0.0

    def lines(self) -> list[str]:
        """The summary as text."""
        spent = ", ".join(f"{state} {seconds:.1f} s" for state, seconds in self.seconds.items())
        lines = [
            f"frames    {self.sent} sent, {self.answered} answered ({self.answered_share:.1%})",
            f"states    {spent or 'none'}",
        ]
        if len(self.latencies):
            median, most = np.percentile(self.latencies, (50, 95))
            lines.append(f"latency   {median:.1f} ms (median), {most:.1f} ms (95 %)")
        if self.score:
            lines.append(
                f"accuracy  mean IoU {self.score.mean_overlap:.3f}, centre within 20 px in "
                f"{self.score.p20:.1%} of {self.score.frames} frames"
            )
        if self.hidden:
            told = f"COASTING or LOST in {self.hidden_told} of them"
            lines.append(f"hidden    in {self.hidden} frames; {told}")
        return lines


def summarise(
    rows: Sequence[Row], truth: Sequence[Truth], latencies: NDArray[np.float64]
) -> Summary:
    """Sum up n answers to n frames, with the times (ms) that they took."""
    step = 1 / usual_rate(rows)
    counts = {state: sum(row.state is state for row in rows) for state in State}
    pairs = zip(rows, truth, strict=True)
    hidden = [row.state for row, true in pairs if true.hidden and row.state is not None]
    return Summary(
        sent=len(rows),
        answered=sum(row.state is not None for row in rows),
        seconds={state.value: n * step for state, n in counts.items() if n},
        latencies=latencies,
        score=_score(rows, truth),
        hidden=len(hidden),
        hidden_told=sum(state in (State.COASTING, State.LOST) for state in hidden),
    )


def usual_rate(rows: Sequence[Row]) -> float:
    """Frames/s by the median distance of stamps."""
    steps = np.diff([row.stamp for row in rows]) * 1e-9
    usual = float(np.median(steps)) if len(steps) else 0.0
    return min(1 / usual, 1000.0) if usual > 0 else 30.0


def _score(rows: Sequence[Row], truth: Sequence[Truth]) -> Score | None:
    """Score as the benchmark does, from the first true box on."""
    first = next((i for i, true in enumerate(truth) if true.seen_box), None)
    if first is None or not any(row.box for row in rows):
        return None
    return score(
        _array([row.box for row in rows[first:]]), _array([t.seen_box for t in truth[first:]])
    )


def _array(boxes: Sequence[Box | None]) -> NDArray[np.float64]:
    """(n, 4) boxes, NaN where there is none."""
    return np.array([box.as_tuple() if box else NO_BOX for box in boxes], np.float64)
