# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json

import pytest

from het_ros.scene import SceneConfig
from het_ros.scene.honesty import Honesty
from het_ros.tools import scenes
from het_ros.tracking.config import TrackerConfig


@pytest.mark.parametrize("more", [[], ["--gray"]], ids=["colour", "gray"])
def test_a_story_is_followed_and_told(capsys, tmp_path, monkeypatch, more):
    camera = SceneConfig(width=160, height=120, rate=5.0, seconds=2.0)
    monkeypatch.setattr(scenes, "CAMERAS", (camera,))
    out = tmp_path / "results" / "scenes.json"
    given = ["--stories", "plain_walk", "--seeds", "2", "--jobs", "1", "--out", str(out)]
    assert scenes.main(given + more) == 0
    tables = capsys.readouterr().out
    assert "| plain_walk | 2 | 2 |" in tables
    assert "No scene has enough frames" in tables, "ten frames are too few for a velocity"
    rows = json.loads(out.read_text())
    assert [row["scene"]["seed"] for row in rows] == [0, 1]
    assert all(row["ends_on_target"] and row["velocity"] is None for row in rows)


def test_the_tracker_gets_what_was_asked_for(monkeypatch):
    given = []
    monkeypatch.setattr(scenes, "followed", lambda scene, tracker, gray: given.append(tracker))
    monkeypatch.setattr(scenes, "honesty", lambda moments, rate: None)
    monkeypatch.setattr(scenes.scene_velocity, "velocity_of", lambda moments, rate: None)
    scenes.judged(SceneConfig(), tracker_seed=3, network="folder")
    assert given == [TrackerConfig(seed=3, network="folder")]


def test_what_the_table_says_of_good_and_bad_scenes():
    good = Honesty(1.0, 0.2, True, 0, 0)
    bad = Honesty(0.8, None, False, 7, 3)
    walk, hide = SceneConfig(story="plain_walk"), SceneConfig(story="hidden_1s")
    lines = scenes.table([(walk, good), (hide, good), (hide, bad)]).splitlines()
    assert lines[2] == "| plain_walk | 1 | 1 | 0.20 s | 1.00 (1.00) | 0 | 0 |"
    assert lines[3] == (
        "| hidden_1s | 2 | 1 | 0.20 s | 0.90 (0.80) | 7, in 1 of them | 3, in 1 of them |"
    )
    assert lines[-1] == "F of visible is under 0.9 in 1 of 3."


@pytest.mark.parametrize(
    ("given", "told"),
    [(["--stories", "rain"], "there is no story rain"), (["--seeds", "0"], "1 or more")],
)
def test_what_cannot_be_done_is_said(given, told, capsys):
    with pytest.raises(SystemExit):
        scenes.main(given)
    assert told in capsys.readouterr().err
