# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.evaluation.drawing import colours, draw_boxes
from het_ros.evaluation.published import compare
from het_ros.evaluation.strips import disagreement, spaced_peaks


def test_boxes_are_drawn_in_their_colour_where_they_are():
    image = np.zeros((40, 60, 3), np.uint8)
    palette = colours(["a", "b"])
    assert palette["a"] != palette["b"]
    drawn = draw_boxes(image, {"a": np.array([10, 10, 20, 10.0])}, palette, scale=2)
    assert drawn.shape == (80, 120, 3)
    assert tuple(drawn[20, 40]) == palette["a"][::-1], "BGR"
    assert not drawn[50:].any()
    assert not image.any(), "the caller's image stays as it is"


def test_a_box_that_is_no_box_or_far_away_is_not_drawn():
    image = np.zeros((40, 60, 3), np.uint8)
    boxes = {"a": np.full(4, np.nan), "b": np.array([1e12, 0, 5, 5])}
    assert not draw_boxes(image, boxes, colours(["a", "b"])).any()


def test_the_frames_shown_are_those_of_most_disagreement_apart():
    values = np.zeros(100)
    values[[20, 21, 22, 70]] = [5, 9, 8, 3]
    assert spaced_peaks(values, 2) == [21, 70]
    assert len(spaced_peaks(np.zeros(3), 5)) == 3


def test_disagreement_is_zero_where_no_box_is_true():
    spread = disagreement([np.array([1, 0.5, np.nan]), np.array([0, 0.5, np.nan])])
    assert spread == pytest.approx([0.5, 0, 0])


def test_published_figures_stand_beside_ours_for_sequences_in_common(tmp_path):
    file = tmp_path / "published.json"
    file.write_text('{"per_sequence_overlap": {"A": {"X": 0.5}, "B": {"X": 0.7}, "C": {"X": 0}}}')
    own = {"auc": 0.5, "sequences": {s: {"mean_overlap": 0.6} for s in ("A", "B", "D")}}
    results = {"sequences": ["A", "B", "D"], "trackers": {"het": own}}
    found = compare(file, results)
    assert found["sequences"] == ["A", "B"]
    assert found["trackers"]["X"]["mean"] == pytest.approx(0.6)
    assert found["trackers"]["het (ours)"]["ours"]
    assert compare(file, results, excluded=["B"])["sequences"] == ["A"]
