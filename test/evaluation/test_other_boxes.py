# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json

import numpy as np
import pytest

from het_ros.evaluation import other_boxes
from het_ros.evaluation.readers import read_sequences

from .doubles import write_sequence


@pytest.fixture
def two(tmp_path):
    boxes = [(5 + 2 * i, 12, 14, 16) for i in range(8)]
    return [write_sequence(tmp_path / name, boxes) for name in ("walk", "run")]


def write(folder, sequence, boxes, separator=","):
    folder.mkdir(exist_ok=True)
    lines = (separator.join(f"{v:g}" for v in box) for box in np.add(boxes, (1, 1, 0, 0)))
    (folder / f"{sequence}.txt").write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize("separator", [",", "\t", " "])
def test_perfect_boxes_have_a_perfect_score(two, tmp_path, separator):
    write(tmp_path / "b", "walk", two[0].truth, separator)
    found = other_boxes.scored({"them": tmp_path / "b"}, two)["them"]
    assert (found["auc"], found["p20"]) == (20 / 21, 1)
    assert list(found["sequences"]) == ["walk"], "the other is not theirs"


def test_ours_are_averaged_over_the_sequences_that_they_have(two, tmp_path):
    write(tmp_path / "b", "walk", two[0].truth)
    write(tmp_path / "b", "run", two[1].truth[:5])
    others = other_boxes.scored({"them": tmp_path / "b"}, two)
    sequences = {"walk": {"auc": 0.25, "p20": 0.5}, "run": {"auc": 0.75, "p20": 1.0}}
    ours = {"het": {"auc": 0.5, "sequences": sequences}}
    means, by_sequence = other_boxes.tables(others, {"trackers": ours, "sequences": [*sequences]})
    cells = [cell.text for cell in means.rows[0].cells]
    assert cells == ["them", "1", "0.952 / 1.000", "0.250 / 0.500"]
    assert "them, run (5 boxes for 8 frames)" in means.note
    assert [row.cells[0].text for row in by_sequence.rows] == ["walk"]


def test_what_is_not_the_published_sequence_is_left_out(two, tmp_path):
    for sequence in two:
        write(tmp_path / "b", sequence.name, sequence.truth)
    found = other_boxes.scored({"them": tmp_path / "b"}, two, excluded=["run"])["them"]
    assert list(found["sequences"]) == ["walk"]


@pytest.mark.parametrize("text", ["folder", "=folder", "name="])
def test_a_wrong_option_says_what_it_takes(text):
    with pytest.raises(ValueError, match="--boxes takes NAME=folder"):
        other_boxes.named([text])


def test_a_folder_without_boxes_says_what_is_looked_for(tmp_path, two):
    with pytest.raises(ValueError, match=r"SEQUENCE\.txt with x,y,w,h a line"):
        other_boxes.named([f"them={tmp_path / 'none'}"])
    write(tmp_path / "b", "walk", two[0].truth[:3])
    with pytest.raises(ValueError, match=r"none of the sequences\. walk: 3 boxes for 8 frames"):
        other_boxes.scored({"them": tmp_path / "b"}, two)


def test_strucks_published_boxes(data, published, tmp_path):
    """They have their published mean overlap when read from OTB's text."""
    names = ("Crossing", "Skiing", "Human3")
    runs = json.loads((published / "struck_boxes.json").read_text())["sequences"]
    for name in names:
        write(tmp_path / "struck", name, np.array(runs[name]["boxes"], float) - (1, 1, 0, 0))
    sequences = read_sequences(data, names)
    found = other_boxes.scored({"STRUCK": tmp_path / "struck"}, sequences)["STRUCK"]
    figures = json.loads((published / "otb_ope.json").read_text())["per_sequence_overlap"]
    for name in ("Crossing", "Skiing"):
        # The success curve's mean over 21 thresholds is within half a step of the mean overlap.
        assert found["sequences"][name]["auc"] == pytest.approx(figures[name]["STRUCK"], abs=0.03)
    assert found["left_out"].keys() == {"Human3"}, "its frames here are cut"
