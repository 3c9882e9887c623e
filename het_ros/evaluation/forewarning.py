# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Does the score fall before the box goes wrong? Failures, and when each was told."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.metrics import overlaps
from het_ros.evaluation.runs import Run

WRONG = 0.2  # overlap under which a box is wrong
LASTING = 5  # frames in a row that make a failure
DOUBT = 0.5  # score under which the tracker warns
LOOK_BACK = 15  # frames before a failure in which a warning counts as one of it


@dataclass(frozen=True)
class Failure:
    """One time that the box went wrong while the target could be seen.

    Attributes:
        sequence: of the run.
        first: the first wrong frame.
        last: the last wrong one before the box is right again, the target absent, or the end.
        lead: frames from the warning to the failure; negative where the warning came after;
            None where there was none at all while the box was wrong.
    """

    sequence: str
    first: int
    last: int
    lead: int | None


def forewarning(pairs: Iterable[tuple[Run, NDArray[np.float64]]]) -> dict[str, Any]:
    """How many failures were told by a score under 0.5, and when.

    A failure is an overlap under 0.2 for 5 frames or more in a row, the target visible, after a
    frame that was right. It is told in time where the score is under 0.5 in the 15 frames before
    it or in its first frame; late where it falls later while the box is wrong. ``lead_frames`` is
    the median over the told ones, ``delays`` how many frames each late one came late, and
    ``wrong_but_sure`` the share of all wrong frames with a score of 0.5 or more.

    Args:
        pairs: runs with scores, and the truth (n, 4) px of their frames.
    """
    found, wrong, sure = [], 0, 0
    for run, truth in pairs:
        found += failures(run, truth)
        bad = _bad(run, truth)
        wrong += int(bad.sum())
        sure += int((bad & (run.track.scores >= DOUBT)).sum())
    leads = [failure.lead for failure in found if failure.lead is not None]
    in_time = [lead for lead in leads if lead >= 0]
    return {
        "failures": len(found),
        "told_in_time": len(in_time),
        "told_late": len(leads) - len(in_time),
        "never_told": len(found) - len(leads),
        "lead_frames": float(np.median(leads)) if leads else None,
        "delays": sorted(-lead for lead in leads if lead < 0),
        "wrong_frames": wrong,
        "wrong_but_sure": sure / wrong if wrong else None,
    }


def failures(run: Run, truth: NDArray[np.float64]) -> list[Failure]:
    """Every failure of a run, see :func:`forewarning`."""
    bad = _bad(run, truth)
    doubt = ~(run.track.scores >= DOUBT)  # no score counts as doubt
    edges = np.flatnonzero(np.diff(np.concatenate([[0], bad.astype(int), [0]])))
    found = []
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        if end - first < LASTING or first == 0 or not _right(run, truth, first - 1):
            continue
        begin = max(first - LOOK_BACK, 1)
        warned = np.flatnonzero(doubt[begin:end])
        lead = int(first - begin - warned[0]) if len(warned) else None
        found.append(Failure(run.sequence, int(first), int(end) - 1, lead))
    return found


def _bad(run: Run, truth: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Frames with the target visible and the box wrong."""
    overlap = overlaps(run.track.boxes, truth)
    return np.asarray(~np.isnan(truth).any(axis=1) & ~(overlap >= WRONG))


def _right(run: Run, truth: NDArray[np.float64], row: int) -> bool:
    """Whether the box was right in a frame; with the target absent it is neither."""
    return bool(overlaps(run.track.boxes[row : row + 1], truth[row : row + 1])[0] >= WRONG)
