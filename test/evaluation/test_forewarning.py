# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.evaluation.answers import Track
from het_ros.evaluation.forewarning import failures, forewarning
from het_ros.evaluation.runs import Run

HERE, AWAY, NAN = (10, 10, 10, 10), (90, 90, 10, 10), (np.nan,) * 4


def pair(boxes: str, scores: list[float], absent: tuple[int, ...] = ()):
    """A run of one letter a frame: r for a right box, w for a wrong one."""
    track = Track.empty(len(boxes))
    track.boxes[:] = [HERE if letter == "r" else AWAY for letter in boxes]
    track.scores[:] = scores
    truth = np.array([NAN if i in absent else HERE for i in range(len(boxes))], float)
    return Run("x", "street", 0, "ope", slice(0, None), track), truth


def scores(count: int, low: range) -> list[float]:
    return [0.1 if i in low else 0.9 for i in range(count)]


@pytest.mark.parametrize(
    "low, lead",
    [
        (range(26, 40), 4),
        (range(30, 40), 0),
        (range(33, 40), -3),
        (range(0), None),
        (range(5, 8), None),  # long before: another matter
        (range(18, 20), 12),
    ],
)
def test_when_a_failure_is_told(low, lead):
    run, truth = pair("r" * 30 + "w" * 10, scores(40, low))
    (failure,) = failures(run, truth)
    assert (failure.first, failure.last, failure.lead) == (30, 39, lead)
    assert failure.sequence == "street"


@pytest.mark.parametrize(
    "boxes, absent",
    [
        ("r" * 20, ()),
        ("r" * 10 + "w" * 4 + "r" * 6, ()),  # too short
        ("r" * 10 + "w" * 10, tuple(range(10, 20))),  # nothing to be seen
        ("w" * 20, ()),  # never was right
        ("r" * 10 + "w" * 10, (9,)),  # it comes back: a loss of before
    ],
)
def test_what_is_no_failure(boxes, absent):
    assert failures(*pair(boxes, [0.9] * 20, absent)) == []


def test_sums():
    told = pair("r" * 30 + "w" * 10, scores(40, range(27, 40)))
    late = pair("r" * 30 + "w" * 10, scores(40, range(32, 40)))
    never = pair("r" * 30 + "w" * 10, scores(40, range(0)))
    assert forewarning([told, late, never]) == {
        "failures": 3,
        "told_in_time": 1,
        "told_late": 1,
        "never_told": 1,
        "lead_frames": 0.5,
        "delays": [2],
        "wrong_frames": 30,
        "wrong_but_sure": pytest.approx(12 / 30),
    }


def test_no_failures_at_all():
    assert forewarning([pair("r" * 9, [0.9] * 9)])["lead_frames"] is None
