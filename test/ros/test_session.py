# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros import Box, State, TrackerConfig
from het_ros.ros.session import TrackingSession
from het_ros.ros.stamps import SECOND

STEP = SECOND // 30


@pytest.fixture
def started(made_footage):
    frames, box = made_footage
    session = TrackingSession(TrackerConfig(), max_gap=0.5)
    session.start(frames[0], 0, Box(*box), "camera")
    return session, frames


def test_without_a_box_there_is_nothing_to_say(made_footage):
    session = TrackingSession(TrackerConfig(), max_gap=0.5)
    assert session.follow(made_footage[0][0], 0) is None
    assert (session.state, session.reason) == (State.IDLE, "waiting for a box")


def test_follows_the_target(started):
    session, frames = started
    for i, frame in enumerate(frames[1:20], 1):
        estimate = session.follow(frame, i * STEP, "camera")
    assert estimate.box.iou(Box(20 + 2 * 19, 40 + 19 // 2, 20, 32)) > 0.6
    assert (session.state, session.reason, session.age) == (State.TRACKING, "", 0)


@pytest.mark.parametrize(
    "box, says",
    [
        (Box(-50, -50, 20, 20), "wholly outside"),
        (Box(160, 10, 20, 20), "wholly outside"),
        (Box(0, 0, 3000, 20), "send pixels"),
        (Box(0, 0, 1e30, 1e30), "send pixels"),
    ],
)
def test_a_refused_box_leaves_the_track_as_it_was(started, box, says):
    session, frames = started
    same = TrackingSession(TrackerConfig(), max_gap=0.5)
    same.start(frames[0], 0, Box(20, 40, 20, 32), "camera")
    with pytest.raises(ValueError, match=says):
        session.start(frames[1], STEP, box, "camera")
    left, right = (s.follow(frames[1], STEP, "camera") for s in (session, same))
    assert left.box == right.box
    assert left.velocity == right.velocity


@pytest.mark.parametrize(
    "change, says",
    [
        (lambda frame: {"stamp": round(0.6 * SECOND)}, "no image for 0.6 s"),
        (lambda frame: {"image": cv2.resize(frame, (80, 60))}, "160 x 120 to 80 x 60"),
        (lambda frame: {"source": "another"}, "frame_id"),
    ],
)
def test_what_breaks_a_track(started, change, says):
    session, frames = started
    frame = {"image": frames[1], "stamp": STEP, "source": "camera"} | change(frames[1])
    assert session.follow(**frame) is None
    assert session.state is State.LOST
    assert says in session.reason
    assert session.follow(frames[2], 2 * STEP, "camera") is None  # stays so until a new box
    assert session.state is State.LOST


def test_a_camera_that_turns_gray_and_back_is_followed(started):
    session, frames = started
    for i, frame in enumerate(frames[1:10], 1):
        gray = cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY) if i % 3 == 0 else frame
        assert session.follow(gray, i * STEP, "camera") is not None
    assert session.state is not State.LOST


def test_same_input_same_output(made_footage):
    frames, box = made_footage
    runs = []
    for _ in range(2):
        session = TrackingSession(TrackerConfig(), max_gap=0.5)
        session.start(frames[0], 0, Box(*box))
        runs.append([session.follow(f, i * STEP) for i, f in enumerate(frames[1:8], 1)])
    for left, right in zip(*runs, strict=True):
        assert (left.box, left.velocity, left.score) == (right.box, right.velocity, right.score)
        np.testing.assert_array_equal(left.covariance, right.covariance)
