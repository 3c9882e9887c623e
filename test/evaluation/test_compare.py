# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json

import cv2
import numpy as np
import pytest

from het_ros.evaluation import cli, comparison, raw_boxes
from het_ros.evaluation.answers import Track
from het_ros.evaluation.comparison_pictures import PALETTE
from het_ros.evaluation.groups import Mean
from het_ros.evaluation.metrics import score
from het_ros.evaluation.runs import Run

from .doubles import write_sequence

NAMES = ("Woman", "Car1", "DTB70-Gull1", "elsewhere")


@pytest.fixture
def data(tmp_path):
    boxes = [(10 + i, 12, 14, 16) for i in range(20)]
    return [write_sequence(tmp_path / "data" / name, boxes) for name in NAMES]


def results(folder, sequences, shifts, protocol="ope", tracker="het"):
    """A results folder of a tracker whose boxes lie beside the truth, by sequence and seed."""
    figures, runs = {}, []
    for sequence in sequences:
        scores = []
        for seed, shift in enumerate(shifts[sequence.name]):
            track = Track.empty(len(sequence.frames))
            track.boxes[:] = sequence.truth + np.array([shift, 0, 0, 0])
            track.boxes[0] = sequence.truth[0]
            runs.append(Run(tracker, sequence.name, seed, "ope", slice(0, None), track))
            scores.append(score(track.boxes, sequence.truth))
        figures[sequence.name] = {
            figure: float(np.mean([getattr(s, figure) for s in scores]))
            for figure in comparison.FIGURES
        } | {"auc_std": float(np.std([s.auc for s in scores]))}
    trackers = {tracker: {"sequences": figures, "seeds": len(runs) // len(figures)}, "other": {}}
    content = {"protocol": protocol, "date": "2001-02-03", "trackers": trackers}
    content["data"] = str(folder.parent / "data")
    folder.mkdir()
    (folder / "results.json").write_text(json.dumps(content))
    raw_boxes.write(runs, {tracker: tracker}, folder / "boxes")
    return folder


@pytest.fixture
def folders(tmp_path, data):
    before = dict.fromkeys(NAMES, (2, 4))
    after = {"Woman": (0, 0), "Car1": (2, 4), "DTB70-Gull1": (5, 9), "elsewhere": (1, 1)}
    return results(tmp_path / "a", data, before), results(tmp_path / "b", data, after)


def test_differences_are_paired_by_sequence_with_seeds_averaged(folders):
    a, b = (json.loads((f / "results.json").read_text())["trackers"]["het"] for f in folders)
    found = comparison.compare(*(comparison.side(str(folder)) for folder in folders)).as_json()
    for figure in ("auc", "p20", "norm_precision"):
        moved = [b["sequences"][n][figure] - a["sequences"][n][figure] for n in NAMES]
        whole = found["groups"][figure]["all"]
        assert whole["mean"] == pytest.approx(sum(moved) / 4)
        centred = [m - sum(moved) / 4 for m in moved]
        expected = (sum(c * c for c in centred) / 3) ** 0.5 / 2
        assert whole["standard_error"] == pytest.approx(expected)
        first = found["groups"][figure]["seen in development first"]
        assert first["mean"] == pytest.approx((moved[0] + moved[1]) / 2), "Woman and Car1"


def test_the_whole_command(folders, tmp_path, capsys):
    a, b = folders
    assert cli.main(["--compare", str(a), str(b), "--out", str(tmp_path / "c")]) == 0
    shown = capsys.readouterr().out
    text = (tmp_path / "c" / "compare.md").read_text()
    for said in ("| all | 4 |", "| from the air | 1 |", "## Sequences that moved most"):
        assert said in shown
        assert said in text
    moved = shown[shown.index("## Sequences that moved most") :]
    order = [moved.index(f"| {name} |") for name in ("DTB70-Gull1", "Car1", "elsewhere", "Woman")]
    assert order == sorted(order), "lost most first"
    written = json.loads((tmp_path / "c" / "compare.json").read_text())
    assert len(written["differences"]["auc"]) == 4

    drawn = [file.name for file in (tmp_path / "c" / "worst").iterdir()]
    assert drawn == ["DTB70-Gull1.jpg"], "only what lost"
    assert "(worst/DTB70-Gull1.jpg)" in text
    picture = cv2.imread(str(tmp_path / "c" / "worst" / drawn[0])).astype(int)
    for colour in PALETTE.values():
        assert (np.abs(picture - colour[::-1]).max(axis=2) < 60).any(), "both boxes are there"


def test_honesty_and_velocity_are_paired_where_both_sides_have_them(folders, capsys):
    for folder, off, error in zip(folders, (0.1, 0.3), (2.0, None), strict=True):
        file = folder / "results.json"
        content = json.loads(file.read_text())
        honest = {"off": off, "recall": 1, "longest_false_lost": 0, "published_auc": None}
        moves = {"published": error, "change": error, "lag": 1.0}
        moves["ahead"] = {"0.2": {"velocity": None}}
        content["trackers"]["het"] |= {
            "honesty": {"sequences": dict.fromkeys(NAMES[:2], honest)},
            "velocity": {"Woman": moves},
        }
        file.write_text(json.dumps(content))
    assert cli.main(["--compare", *map(str, folders)]) == 0
    shown = capsys.readouterr().out
    said = "| share of frames confident and off | 2 | 0.100 | 0.300 | +0.2000 ± 0.0000 |"
    assert said in shown
    assert "| its lag, frames | 1 | 1.000 | 1.000 | +0.0000 | - |" in shown
    assert "error of velocity" not in shown, "only one side knows it"


def test_a_tracker_of_a_folder_is_named_after_a_colon(folders):
    a, _ = folders
    assert comparison.side(f"{a}:het") == comparison.side(str(a))
    assert comparison.side(f"{a}:other").tracker == "other"


def test_the_same_twice_is_no_difference(folders, capsys):
    a, _ = folders
    assert cli.main(["--compare", str(a), str(a)]) == 0
    assert "+0.0000 ± 0.0000 | - |" in capsys.readouterr().out
    assert (a / "compare" / "compare.md").is_file()
    assert not list((a / "compare").glob("worst/*.jpg"))


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.04, 0.02, "+2.0"),
        (-0.03, 0.02, "-1.5"),
        (0.04, None, "-"),
        (0, 0, "-"),
        (1e-9, 1e-9, "-"),
    ],
)
def test_a_difference_in_its_standard_errors(value, error, text):
    assert comparison.in_errors(Mean(value, error, 3)) == text


def test_sequences_that_only_one_side_has_are_named_and_left_out(folders, data, tmp_path, capsys):
    few = results(tmp_path / "few", data[:2], dict.fromkeys(NAMES, (1, 1)))
    assert cli.main(["--compare", str(folders[0]), str(few)]) == 0
    shown = capsys.readouterr().out
    assert "only one side has them: DTB70-Gull1, elsewhere." in shown
    assert "| all | 2 |" in shown


def test_one_seed_is_compared_with_several(folders, data, tmp_path):
    one = results(tmp_path / "one", data, dict.fromkeys(NAMES, (6,)))
    assert cli.main(["--compare", str(folders[0]), str(one)]) == 0
    assert (one / "compare" / "worst" / "Woman.jpg").is_file()


def test_without_the_sequences_there_are_figures_and_no_pictures(folders, tmp_path, capsys):
    a, b = folders
    nowhere = ["--data", str(tmp_path / "nowhere")]
    assert cli.main(["--compare", str(a), str(b), *nowhere]) == 0
    said = capsys.readouterr()
    assert "no pictures: " in said.err
    assert "is not a folder" in said.err
    assert "| all | 4 |" in said.out


@pytest.mark.parametrize(
    ("right", "complaint"),
    [
        ("nowhere", "nowhere holds no results"),
        ("a:nobody", "has no tracker 'nobody'; it has het, other"),
        ("tre", "only runs of one protocol can be compared"),
        ("apart", "share no sequence"),
    ],
)
def test_what_cannot_be_compared_is_said(folders, data, tmp_path, right, complaint, capsys):
    results(tmp_path / "tre", data, dict.fromkeys(NAMES, (1,)), protocol="tre")
    elsewhere = write_sequence(tmp_path / "more" / "apart", [(1, 1, 9, 9)] * 2)
    results(tmp_path / "apart", [elsewhere], {"apart": (1,)})
    assert cli.main(["--compare", str(folders[0]), str(tmp_path / right)]) == 2
    assert complaint in capsys.readouterr().err


def test_without_data_or_compare_the_command_says_what_it_needs(capsys):
    assert cli.main(["--out", "out"]) == 2
    assert "--data and --out are needed, or --compare A B" in capsys.readouterr().err
