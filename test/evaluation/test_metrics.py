# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json

import numpy as np
import pytest

from het_ros.evaluation.metrics import (
    centre_errors,
    normalised_errors,
    overlaps,
    precision_curve,
    repaired,
    score,
    success_curve,
)
from het_ros.evaluation.readers import read_sequences
from het_ros.tracking.box import Box

NAN = [np.nan] * 4


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ((0, 0, 10, 10), (0, 0, 10, 10), 1),
        ((0, 0, 10, 10), (5, 0, 10, 10), 1 / 3),
        ((0, 0, 10, 10), (10, 0, 10, 10), 0),  # edges that touch share nothing
        ((0, 0, 10, 10), (2, 2, 5, 5), 0.25),
        ((-5, -5, 10, 10), (0, 0, 5, 5), 0.25),
    ],
)
def test_overlap_is_intersection_over_union(a, b, expected):
    assert overlaps(np.array([a], float), np.array([b], float)) == pytest.approx([expected])
    assert Box(*a).iou(Box(*b)) == pytest.approx(expected)


def test_errors_are_those_of_the_centres():
    a, b = np.array([[0, 0, 10, 20.0]]), np.array([[3, 4, 10, 20.0]])
    assert centre_errors(a, b) == pytest.approx([5])
    assert normalised_errors(a, b) == pytest.approx([np.hypot(0.3, 0.2)])


def test_success_is_strictly_over_and_precision_at_most_the_threshold():
    assert success_curve(np.array([0.0]))[0] == 0
    assert success_curve(np.array([1.0])).tolist() == [1] * 20 + [0]
    assert precision_curve(np.array([20.0]))[[19, 20]].tolist() == [0, 1]


def test_a_perfect_tracker_scores_what_arithmetic_says():
    truth = np.array([[1, 2, 30, 40.0]] * 5)
    result = score(truth, truth)
    assert result.auc == pytest.approx(20 / 21)
    assert (result.p20, result.norm_precision, result.mean_overlap) == (1, 1, 1)


def test_the_first_frame_counts_as_the_truth():
    truth = np.array([[0, 0, 10, 10.0]] * 4)
    far = truth + np.array([500, 500, 0, 0])
    result = score(far, truth)
    assert result.mean_overlap == pytest.approx(1 / 4)
    assert result.auc == pytest.approx(20 / 21 / 4)
    assert result.p20 == pytest.approx(1 / 4)


def test_frames_without_a_valid_box_are_left_out():
    truth = np.array([[0, 0, 10, 10], NAN, [0, 0, 10, 10], NAN], float)
    boxes = np.array([[0, 0, 10, 10]] * 4, float)
    assert score(boxes, truth).frames == 2
    assert score(boxes, truth).mean_overlap == 1


def test_a_row_that_is_no_box_counts_as_the_one_before():
    boxes = np.array([[0, 0, 10, 10], NAN, [1, 1, 0, 5], [2, 2, 5, 5]], float)
    assert repaired(boxes)[:, 0].tolist() == [0, 0, 0, 2]
    assert np.isnan(boxes[1]).all(), "the caller's array stays as it is"


def test_a_run_of_another_length_cannot_be_scored():
    with pytest.raises(ValueError, match="3 boxes cannot be scored against 4"):
        score(np.ones((3, 4)), np.ones((4, 4)))


STRUCK = [
    *("Bolt2", "Car1", "Couple", "Crossing", "David", "Dog1", "DragonBaby", "FaceOcc1"),
    *("Freeman1", "Human7", "Jogging-1", "Jogging-2", "MotorRolling", "Skiing", "Woman"),
]


@pytest.mark.parametrize("name", STRUCK)
def test_published_boxes_get_their_published_overlap(name, data, published):
    runs = json.loads((published / "struck_boxes.json").read_text())["sequences"]
    figures = json.loads((published / "otb_ope.json").read_text())["per_sequence_overlap"]
    boxes = np.array(runs[name]["boxes"], float) - (1, 1, 0, 0)
    (sequence,) = read_sequences(data, (name,))
    result = score(boxes, sequence.truth)
    assert result.mean_overlap == pytest.approx(figures[name]["STRUCK"], abs=0.001)
