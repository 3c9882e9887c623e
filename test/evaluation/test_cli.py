# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json
import re

import numpy as np
import pytest

from het_ros.evaluation import cli, raw_boxes
from het_ros.evaluation.choice import Choice, chosen
from het_ros.evaluation.opencv_peers import available

from .doubles import write_sequence


@pytest.fixture
def folder(tmp_path):
    """Two sequences with attributes, one of them with an absence."""
    boxes = [(5 + 2 * i, 12, 14, 16) for i in range(12)]
    write_sequence(tmp_path / "data" / "walk", boxes)
    gone = [None if 5 <= i < 8 else box for i, box in enumerate(boxes)]
    write_sequence(tmp_path / "data" / "gone", gone)
    (tmp_path / "data" / "attributes.json").write_text('{"walk": ["FM"], "gone": ["OCC", "FM"]}')
    return tmp_path


def run(folder, *options):
    paths = ["--data", str(folder / "data"), "--out", str(folder / "out")]
    return cli.main([*paths, "--quiet", *options])


def results(folder):
    text = (folder / "out" / "results.json").read_text()
    assert "NaN" not in text, "plain JSON has no NaN"
    return json.loads(text)


def test_the_whole_command(folder, capsys):
    figures = {"source": "somewhere", "per_sequence_overlap": {"walk": {"OTHER": 0.5}}}
    figures["sets"] = {"ALL": {"OTHER": {"auc": 0.4, "p20": 0.6}}}
    (folder / "published.json").write_text(json.dumps(figures))
    options = ["--trackers", "het,identity", "--seeds", "2", "--timing", "4", "--video"]
    assert run(folder, *options, "--published", str(folder / "published.json")) == 0

    found = results(folder)
    assert {"protocol", "seeds", "machine", "trackers"} <= found.keys()
    assert (found["protocol"], found["seeds"]) == ("ope", 2)
    for name, seeds in (("het", 2), ("identity", 1)):
        tracker = found["trackers"][name]
        keys = {"auc", "auc_std", "p20", "mean_overlap", "fps", "p99_ms", "sequences"}
        assert keys <= tracker.keys()
        assert tracker["seeds"] == seeds
        assert tracker["fps"] > 0 < tracker["p99_ms"]
        for sequence, frames in (("walk", 12), ("gone", 9)):
            of = tracker["sequences"][sequence]
            assert {"auc", "p20", "mean_overlap", "fps", "frames"} <= of.keys()
            assert of["frames"] == frames, "frames without the target are not scored"
        mean = np.mean([tracker["sequences"][s]["auc"] for s in ("walk", "gone")])
        assert tracker["auc"] == pytest.approx(mean)
    het = found["trackers"]["het"]
    assert het["state"]["absent_frames"] == 2 * 3
    assert {"bins", "error"} <= het["calibration"].keys()
    assert {"mean", "within_95"} <= het["nis"].keys()
    assert het["attributes"]["FM"]["sequences"] == 2
    assert "state" not in found["trackers"]["identity"]

    boxes = folder / "out" / "boxes" / "het"
    assert sorted(file.name for file in boxes.iterdir()) == [
        *("gone.txt", "gone_0.txt", "gone_1.txt", "walk.txt", "walk_0.txt", "walk_1.txt")
    ]
    first, *_ = (boxes / "walk_1.txt").read_text().splitlines()
    assert first == "6.000,13.000,14.000,16.000", "OTB counts from 1"
    assert raw_boxes.read(boxes / "walk_1.txt")[0].tolist() == [5, 12, 14, 16]

    text = (folder / "out" / "report.md").read_text()
    assert "| het |" in text
    assert "OTHER" in text
    for title in ("Did it know?", "In short", "AUC by group", "Honesty"):
        assert f"## {title}\n" in text
    assert found["data"] == str(folder / "data")
    mean, groups = het["auc"], het["groups"]["auc"]
    assert groups["all"]["mean"] == pytest.approx(mean)
    assert groups["all"]["sequences"] == 2
    assert {"confident", "off", "recall"} <= het["honesty"]["sequences"]["walk"].keys()
    for plot in re.findall(r"\((plots/.*?)\)", text):
        assert (folder / "out" / plot).read_bytes().startswith(b"\x89PNG")
    compared = folder / "compared"
    assert cli.main(["--compare", *[str(folder / "out")] * 2, "--out", str(compared)]) == 0
    assert "## Honesty and velocity" in (compared / "compare.md").read_text()
    page = (folder / "out" / "report.html").read_text()
    assert "data:image/png;base64," in page
    assert "data:image/jpeg;base64," in page
    assert not re.findall(r'(?:src|href)="(?!data:)', page), "one file is the whole report"
    shown = capsys.readouterr().out
    assert "| het | " in shown

    import av

    for name in ("walk", "gone"):
        with av.open(str(folder / "out" / "video" / f"{name}.mp4")) as video:
            assert sum(1 for _ in video.decode(video=0)) == 12


@pytest.mark.parametrize(
    ("protocol", "variants"),
    [("tre", 12), ("sre", 12), ("passes", 5), ("half_rate", 1), ("realtime", 3), ("restart", 1)],
)
def test_every_protocol_runs_and_reports(folder, protocol, variants):
    options = ["--protocol", protocol, "--trackers", "identity", "--sequences", "walk"]
    assert run(folder, *options, "--timing", "0") == 0
    files = list((folder / "out" / "cache" / "identity").rglob("*.npz"))
    assert len(files) == variants
    tracker = results(folder)["trackers"]["identity"]
    assert 0 < tracker["auc"] < 1
    if protocol == "realtime":
        assert set(tracker["realtime"]) == {"20", "30", "60"}
        assert 0 < tracker["realtime"]["60"]["frames_seen"] <= 1
    if protocol == "restart":
        assert tracker["failures"] == 1, "14 px wide and 2 px a frame: outside after 7 frames"
        assert tracker["accuracy"] is None, "it never lasts longer than the burn-in"
    assert (folder / "out" / "report.html").is_file()


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (["--trackers", "nobody"], "no tracker is called 'nobody'"),
        (["--trackers", "het:colour=1"], "TrackerConfig has no colour"),
        (["--trackers", "het,het"], "names one twice"),
        (["--sequences", "none"], "has no none; it has gone, walk"),
        (["--boxes", "name"], "--boxes takes NAME=folder"),
        (["--protocol", "tre", "--boxes", "a=data/walk"], "--protocol ope"),
        (["--trackers", "vit"], "needs a folder of models, --models FOLDER"),
        (["--fps", "fast"], "--fps takes"),
        (["--cameras", "fast"], "--cameras takes"),
        (["--trackers", "identity", "--published", "absent.json"], "no published figures"),
    ],
)
def test_a_wrong_wish_is_answered_with_what_would_be_right(
    folder, options, complaint, capsys, monkeypatch
):
    monkeypatch.chdir(folder)
    assert run(folder, *options) == 2
    assert complaint in capsys.readouterr().err


def test_without_trackers_named_those_that_are_here_are_compared():
    choice = chosen("")
    names = [spec.name for spec in choice.trackers]
    assert names == ["het", "het-paper", *available()]
    assert ("opencv-contrib" in " ".join(choice.notes)) == (len(available()) < 7)


def test_what_is_left_out_and_boxes_of_others_are_in_the_report(folder, monkeypatch, capsys):
    still = chosen("identity").trackers
    monkeypatch.setattr(cli, "chosen", lambda text, models: Choice(still, ["Left out: a net."]))
    boxes = folder / "boxes"
    boxes.mkdir()
    truth = (folder / "data" / "walk" / "groundtruth_rect.txt").read_text()
    (boxes / "walk.txt").write_text(truth)
    assert run(folder, "--timing", "0", "--boxes", f"perfect={boxes}") == 0
    assert "Left out: a net." in capsys.readouterr().err
    assert results(folder)["boxes"]["perfect"]["auc"] == pytest.approx(20 / 21)
    for file in ("report.md", "report.html"):
        text = (folder / "out" / file).read_text()
        assert "Left out: a net." in text
        assert "Boxes of others beside ours" in text


def test_help_has_an_example(capsys):
    with pytest.raises(SystemExit):
        cli.main(["--help"])
    assert "evaluate --data" in capsys.readouterr().out
