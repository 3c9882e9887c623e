# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The examples do what the pages say of them."""

import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
from moving_target import FIRST_BOX, moving_target

from het_ros import Box, HierarchicalEnsembleTracker, State

ROOT = Path(__file__).parents[2]
ENSEMBLE = ROOT / "examples" / "brightness_ensemble.py"
sys.path.insert(0, str(ROOT))
from examples.brightness_ensemble import BrightnessEnsemble, tracker  # noqa: E402

COUNT = 12
LAST_CENTRE = 20 + 2 * (COUNT - 1) + 10, 40 + (COUNT - 1) // 2 + 16


def test_a_base_ensemble_takes_one_short_file():
    text = ENSEMBLE.read_text()
    assert len(text.splitlines()) < 60
    assert text in (ROOT / "docs" / "how-to" / "base-ensemble.md").read_text()


def test_the_tracker_follows_with_one_more_base_ensemble():
    frames = moving_target(COUNT)
    following = tracker()
    following.init(frames[0], Box(*FIRST_BOX))
    estimates = [following.update(frame, 1 / 30) for frame in frames[1:]]
    assert {e.state for e in estimates} == {State.TRACKING}
    assert np.allclose(estimates[-1].box.centre, LAST_CENTRE, atol=3)


def test_every_target_gets_an_ensemble_that_votes_learns_and_forgets():
    frames, made, calls = moving_target(6), [], []

    class Recorded(BrightnessEnsemble):
        def __init__(self, image, box):
            super().__init__(image, box)
            made.append(box)

        def vote(self, look):
            calls.append("vote")
            votes = super().vote(look)
            assert votes.shape == look.places and votes.dtype == np.float32
            assert 0 <= votes.min() <= votes.max() <= 1
            return votes

        def learn(self, look, box, weight):
            calls.append("learn")
            super().learn(look, box, weight)

        def forget(self):
            calls.append("forget")

    following = HierarchicalEnsembleTracker(further=[Recorded])
    for _ in range(2):
        following.init(frames[0], Box(*FIRST_BOX))
    assert made == [Box(*FIRST_BOX)] * 2
    for frame in frames[1:]:
        following.update(frame, 1 / 30)
    assert calls == ["learn"] * 2 + ["vote", "learn"] * 5
    following.update(np.zeros_like(frames[0]), 1 / 30, witness=lambda box: False)
    assert calls[-1] == "forget"


def test_a_vote_decides_between_two_that_are_alike():
    """Two equal patches, one of which an ensemble votes for."""
    rng = np.random.default_rng(1)
    ground = np.full((120, 200, 3), 90, np.uint8)
    patch = cv2.resize(rng.integers(0, 255, (6, 5, 3), np.uint8), (30, 36))
    first, second = ground.copy(), ground.copy()
    first[40:76, 80:110] = patch
    second[40:76, 60:90] = patch
    second[40:76, 100:130] = patch

    class Right:
        def __init__(self, image, box):
            pass

        def vote(self, look):
            rows, columns = look.places
            corners = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1)
            return (look.centre_of(corners)[..., 0] > 95).astype(np.float32)

        def learn(self, look, box, weight):
            pass

        def forget(self):
            pass

    class Left(Right):
        def vote(self, look):
            return 1 - super().vote(look)

    for side, centre in ((Right, 115), (Left, 75)):
        following = HierarchicalEnsembleTracker(further=[side])
        following.init(first, Box(80, 40, 30, 36))
        following.update(second, 1 / 30)
        peak = following.target.confidence.features
        assert peak is not None
        assert abs(following.update(second, 1 / 30).box.centre[0] - centre) < 12, side


def test_the_script_without_ros_follows_a_video_file(tmp_path):
    footage, out = tmp_path / "walk.avi", tmp_path / "out.mp4"
    frames = moving_target(8)
    writer = cv2.VideoWriter(
        str(footage), cv2.VideoWriter_fourcc(*"MJPG"), 30, frames[0].shape[1::-1]
    )
    for frame in frames:
        writer.write(frame)
    writer.release()
    script = [sys.executable, str(ROOT / "examples" / "track_video.py")]
    box = ",".join(map(str, FIRST_BOX))
    ended = subprocess.run(
        [*script, str(footage), "--box", box, "--out", str(out)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.startswith("TRACKING")
    written = cv2.VideoCapture(str(out))
    assert written.get(cv2.CAP_PROP_FRAME_COUNT) == len(frames)
    written.release()
    missing = subprocess.run(
        [*script, str(tmp_path / "no.avi")], capture_output=True, text=True, check=False
    )
    assert missing.returncode == 2 and "name a video file" in missing.stderr
