# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.evaluation.answers import Track
from het_ros.evaluation.runs import Run
from het_ros.evaluation.state_metrics import (
    calibration,
    consistency,
    longest_row,
    reacquisitions,
    state,
    summarise,
)

HERE, AWAY, NAN = (10, 10, 10, 10), (90, 90, 10, 10), (np.nan,) * 4


def pair(states="", boxes=None, truth=None, scores=None, covariances=None):
    """A run of one letter a frame (T, C, L) on a target that stands still."""
    n = max(len(states), len(boxes or ()), len(truth or ()), len(scores or ()))
    track = Track.empty(n)
    words = {"T": "TRACKING", "C": "COASTING", "L": "LOST"}
    track.states[:] = [words[s] for s in states] if states else ""
    track.boxes[:] = HERE if boxes is None else boxes
    if scores is not None:
        track.scores[:] = scores
    if covariances is not None:
        track.covariances[:] = covariances
    true = np.array([HERE] * n if truth is None else truth, float)
    return Run("x", "s", 0, "ope", slice(0, None), track), true


def test_the_state_against_an_absence():
    #                 0    1    2    3    4    5    6    7    8    9
    truth = [HERE, HERE, HERE, NAN, NAN, NAN, HERE, HERE, HERE, HERE]
    result = state([pair("TTLTLCLLTT", truth=truth)])
    # The first frame does not count. Said visible: 1, 3, 8, 9; visible: 1, 2, 6-9.
    assert result["precision"] == pytest.approx(3 / 4)
    assert result["recall"] == pytest.approx(3 / 6)
    assert result["f"] == pytest.approx(2 * 0.75 * 0.5 / 1.25)
    assert (result["visible_frames"], result["absent_frames"]) == (6, 3)
    assert (result["false_lost"], result["longest_false_lost"]) == (3, 2)
    assert result["missed_lost"] == 1
    assert (result["reappearances"], result["reacquired"]) == (1, 1)
    assert result["reacquisition_frames"] == 2


def test_tracking_somebody_else_is_off_target():
    result = state([pair("TTTT", boxes=[HERE, HERE, AWAY, AWAY])])
    assert result["off_target"] == pytest.approx(2 / 3)
    assert result["f"] == 1, "the target was visible all the time, wherever the box was"


@pytest.mark.parametrize(
    ("flags", "longest"), [("", 0), ("0", 0), ("1", 1), ("110111", 3), ("1110", 3)]
)
def test_longest_row(flags, longest):
    assert longest_row(np.array([f == "1" for f in flags], bool)) == longest


@pytest.mark.parametrize(
    ("seen", "right", "frames"),
    [
        ("1111", "0000", []),  # never gone
        ("1001", "0001", [0]),  # found at once
        ("100111", "000001", [2]),
        ("1011", "0000", [None]),  # never found again
        ("10110111", "00000001", [None, 2]),  # gone again before it was found
    ],
)
def test_reacquisitions(seen, right, frames):
    found = reacquisitions(*(np.array([f == "1" for f in flags]) for flags in (seen, right)))
    assert found == frames


def test_calibration_bins_scores_by_the_share_of_right_frames():
    boxes = [HERE, *[HERE] * 4, *[AWAY] * 4]
    scores = [1, *[0.95, 0.95, 0.15, 0.15] * 2]
    result = calibration([pair(boxes=boxes, scores=scores)])
    assert [(b["frames"], b["right"]) for b in result["bins"]] == [(4, 0.5), (4, 0.5)]
    assert result["error"] == pytest.approx((0.45 + 0.35) / 2)
    assert result["confident_elsewhere"] == 2


def test_a_frame_without_the_target_counts_as_wrong():
    result = calibration([pair(truth=[HERE, NAN], scores=[1.0, 1.0])])
    assert result["bins"] == [{"score": 1.0, "right": 0.0, "frames": 1}]


def test_a_true_covariance_is_consistent_and_a_small_one_is_not():
    draw = np.random.default_rng(3)
    n, wide = 4000, np.array([[4.0, 1.0], [1.0, 2.0]])
    errors = draw.multivariate_normal([0, 0], wide, n)
    truth = [(0, 0, 40, 40)] * n
    boxes = [(dx, dy, 40, 40) for dx, dy in errors]
    good = consistency([pair(boxes=boxes, truth=truth, covariances=wide)])
    assert good["mean"] == pytest.approx(2, abs=0.1)
    assert good["within_95"] == pytest.approx(0.95, abs=0.02)
    vain = consistency([pair(boxes=boxes, truth=truth, covariances=wide / 9)])
    assert vain["mean"] == pytest.approx(9 * good["mean"])


def test_a_singular_covariance_does_not_end_the_report():
    result = consistency([pair(boxes=[HERE] * 3, covariances=np.zeros((2, 2)))])
    assert result["frames"] == 0


def test_what_a_tracker_does_not_say_is_not_judged():
    run, truth = pair(boxes=[HERE] * 3)
    assert summarise([run], {"s": truth}) == {}
