# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
import signal
from pathlib import Path

import av
import pytest

from het_ros import State
from het_ros.tools import replay as replay_module
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.bag_writer import BagWriter
from het_ros.tools.replay import main
from het_ros.tools.results import read_csv

SHIPPED = Path(__file__).resolve().parents[2] / "bags" / "follow_walk"


def test_a_replay_leaves_a_complete_results_folder(crossing_bag, tmp_path, capsys):
    assert main([str(crossing_bag), "--out", str(tmp_path / "out")]) == 0
    assert "40 sent, 40 answered (100.0%)" in capsys.readouterr().out
    rows = read_csv(tmp_path / "out" / "track.csv")
    with BagReader(crossing_bag) as bag:
        stamps, truth = bag.stamps(), bag.truth()
    assert [row.stamp for row in rows] == stamps
    followed = [row for row in rows if row.box]
    assert rows[0].state is State.TRACKING
    assert all(row.velocity for row in followed)
    overlaps = [row.box.iou(truth[row.stamp]) for row in followed]
    assert sum(overlaps) / len(rows) > 0.4
    with BagReader(tmp_path / "out" / "bag") as bag:
        assert bag.counts["/tracker/box"] == bag.counts["/tracker/velocity"] == len(followed)
        # The first image is answered twice: IDLE, and again when its box has come.
        assert [r.time for r in bag.recorded("/tracker/status")] == stamps[:1] + stamps
    with av.open(str(tmp_path / "out" / "track.mp4")) as video:
        assert sum(1 for _ in video.decode(video=0)) == 40
    assert (tmp_path / "out" / "track.png").stat().st_size > 50_000


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_who_is_followed_in_the_shipped_bag_is_followed_past_the_column(tmp_path, seed):
    assert main([str(SHIPPED), "--out", str(tmp_path), "-p", f"seed:={seed}"]) == 0
    with BagReader(SHIPPED) as bag:
        truth = bag.truth()
    rows = read_csv(tmp_path / "track.csv")
    overlaps = [row.box.iou(truth[row.stamp]) if row.box else 0 for row in rows]
    assert sum(overlaps) / len(rows) > 0.5
    last = overlaps[-len(rows) // 3 :]
    assert sum(overlap > 0.3 for overlap in last) > 0.9 * len(last)


def test_two_replays_give_the_same_csv(short_bag, tmp_path):
    for name in ("first", "second"):
        assert main([str(short_bag), "--out", str(tmp_path / name), "-p", "seed:=5"]) == 0
    first, second = (tmp_path / name / "track.csv" for name in ("first", "second"))
    assert first.read_bytes() == second.read_bytes()


def test_a_replay_replaces_an_older_one_and_nothing_else(short_bag, tmp_path):
    (tmp_path / "mine.txt").write_text("keep me")
    for _ in range(2):
        assert main([str(short_bag), "--out", str(tmp_path)]) == 0
    assert (tmp_path / "mine.txt").read_text() == "keep me"


def test_a_folder_of_somebody_else_is_not_removed(short_bag, tmp_path, capsys):
    (tmp_path / "bag").mkdir()
    (tmp_path / "bag" / "thesis.tex").write_text("years of work")
    assert main([str(short_bag), "--out", str(tmp_path)]) == 1
    assert "choose another folder" in capsys.readouterr().err
    assert (tmp_path / "bag" / "thesis.tex").exists()


def test_a_box_of_the_command_line_replaces_the_bags_own(short_bag, tmp_path):
    assert main([str(short_bag), "--out", str(tmp_path), "--init", "100,60,40,30"]) == 0
    first = read_csv(tmp_path / "track.csv")[0]
    assert first.box.as_tuple() == (100, 60, 40, 30)


def test_without_a_box_every_frame_is_answered_idle(short_bag, tmp_path):
    with BagReader(short_bag) as bag, BagWriter(tmp_path / "images") as images:
        for recorded in bag.recorded("/image/compressed"):
            images.write_cdr(recorded.topic, recorded.kind, recorded.cdr, recorded.time)
    assert main([str(tmp_path / "images"), "--out", str(tmp_path / "out")]) == 0
    rows = read_csv(tmp_path / "out" / "track.csv")
    assert {row.state for row in rows} == {State.IDLE}
    assert not any(row.box for row in rows)


def test_a_bag_without_images_is_refused(short_bag, tmp_path, capsys):
    with BagReader(short_bag) as bag, BagWriter(tmp_path / "boxes") as boxes:
        for recorded in bag.recorded("/ground_truth/box"):
            boxes.write_cdr(recorded.topic, recorded.kind, recorded.cdr, recorded.time)
    assert main([str(tmp_path / "boxes"), "--out", str(tmp_path / "out")]) == 1
    assert "no images to play; it holds /ground_truth/box" in capsys.readouterr().err


def test_a_wrong_parameter_is_refused(short_bag, tmp_path, capsys):
    assert main([str(short_bag), "--out", str(tmp_path), "-p", "max_gap:=-3.0"]) == 1
    assert "max_gap" in capsys.readouterr().err


def test_ctrl_c_leaves_what_was_answered(short_bag, tmp_path, monkeypatch):
    seen = 0
    original = replay_module.TrackerNode.on_image

    def interrupted(node, message):
        nonlocal seen
        seen += 1
        if seen == 10:
            os.kill(os.getpid(), signal.SIGINT)
        original(node, message)

    monkeypatch.setattr(replay_module.TrackerNode, "on_image", interrupted)
    assert main([str(short_bag), "--out", str(tmp_path)]) == 130
    assert len(read_csv(tmp_path / "track.csv")) == 10
    with BagReader(tmp_path / "bag") as bag:
        assert bag.counts["/tracker/status"] == 11
    with av.open(str(tmp_path / "track.mp4")) as video:
        assert sum(1 for _ in video.decode(video=0)) == 10
    assert (tmp_path / "track.png").exists()


def test_images_on_any_topic_reach_the_node(short_bag, tmp_path):
    with BagReader(short_bag) as bag, BagWriter(tmp_path / "robot") as robot:
        for recorded in bag.recorded():
            topic = recorded.topic.replace("/image/compressed", "/front/image_rect")
            robot.write_cdr(topic, recorded.kind, recorded.cdr, recorded.time)
    assert main([str(tmp_path / "robot"), "--out", str(tmp_path / "out")]) == 0
    rows = read_csv(tmp_path / "out" / "track.csv")
    assert all(row.state is State.TRACKING for row in rows[:5])
