# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames that get lost, come twice, late or with odd stamps, sent to the installed tracker."""

from __future__ import annotations

import numpy as np
import pytest

from het_ros.faults.disturb import delay, duplicate, freeze, lose, shift, swap
from het_ros.ros.messages import stamp_ns
from het_ros.ros.status import status_values

FRAMES = 60


@pytest.mark.parametrize("share", [0.1, 0.3])
def test_lost_frames(lockstep, share):
    """What arrives is followed: over the gaps the motion model carries the target."""
    stream = lose(lockstep.steady(FRAMES), share, np.random.default_rng(1))
    assert len(stream) < FRAMES * (1 - share / 2)
    lockstep.follow(stream)
    overlaps = lockstep.overlaps(stream)
    assert np.mean(overlaps) > 0.5 and min(overlaps) > 0.2
    assert lockstep.state() == "TRACKING"


@pytest.mark.parametrize(
    "fault, counted",
    [
        (lambda good, rng: duplicate(good, 0.2, rng), "duplicate"),
        (lambda good, rng: swap(good, 0.15, rng), "late"),
        (lambda good, rng: delay(good, 0.2, 0.15, rng), "late"),
    ],
    ids=["duplicated", "reordered", "delayed"],
)
def test_doubled_late_and_reordered_frames_are_dropped_and_counted(lockstep, fault, counted):
    stream = fault(lockstep.steady(FRAMES), np.random.default_rng(2))
    lockstep.follow(stream)
    lockstep.all_counted()
    newest, dropped = -1, 0
    for delivery in stream:
        dropped += delivery.stamp <= newest
        newest = max(newest, delivery.stamp)
    assert lockstep.counted(counted) == dropped > 3
    answered = [stamp_ns(status.header) for status in lockstep.camera.got["status"]]
    assert answered == sorted(answered)
    in_time = [d for d in lockstep.steady(FRAMES) if d.stamp in set(answered)]
    assert len(in_time) == FRAMES - (0 if counted == "duplicate" else dropped)
    assert np.mean(lockstep.overlaps(in_time)) > 0.5
    assert lockstep.state() == "TRACKING"


def test_a_frozen_stamp(lockstep):
    """A driver that stamps twenty frames alike: those are no news, and then it goes on."""
    stream = freeze(lockstep.steady(FRAMES), 20, 40)
    lockstep.follow(stream)
    lockstep.all_counted()
    assert lockstep.counted("duplicate") == 19
    assert lockstep.state() != "LOST"
    assert min(lockstep.overlaps(stream[40:])) > 0.2


def test_stamps_that_go_backwards(lockstep):
    """A clock set back by 5 s: the track is dropped at once, a box starts the next one."""
    stream = shift(lockstep.steady(FRAMES), 20, -5.0)
    lockstep.follow(stream[:20])
    for delivery in stream[20:30]:
        lockstep.send(delivery)
    said = status_values(lockstep.camera.got["status"][-1])
    assert said["state"] == "IDLE" and "jumped back" in said["reason"]
    assert len(lockstep.camera.got["box"]) == 20
    assert lockstep.log.read_text().count("stamps jumped back") == 1
    lockstep.start(stream[29])
    for delivery in stream[30:]:
        lockstep.send(delivery)
    assert lockstep.state() == "TRACKING"
    assert np.mean(lockstep.overlaps(stream[30:])) > 0.5


@pytest.mark.parametrize("seconds", [3600.0, 5.0])
def test_stamps_that_leap_ahead(lockstep, seconds):
    """A clock set forward: for all the node can know, the target was away for so long."""
    stream = shift(lockstep.steady(40), 20, seconds)
    lockstep.follow(stream)
    said = status_values(lockstep.camera.got["status"][-1])
    assert said["state"] == "LOST" and "no image for" in said["reason"]
    lockstep.start(stream[39])
    assert lockstep.state() == "TRACKING"


def test_a_box_of_another_clock(lockstep):
    """Stamped an hour ahead of the images it waits and says so; an hour behind it is refused."""
    stream = lockstep.steady(20)
    lockstep.follow(stream[:10])
    ahead, behind = shift(stream, 0, 3600.0), shift(stream, 0, -600.0)
    for odd in (ahead[9], behind[9]):
        lockstep.send_box(odd)
    lockstep.graph.spin_until(
        lambda: "init box refused" in lockstep.log.read_text(), "the refusal"
    )
    assert "do both clocks agree?" in lockstep.log.read_text()
    lockstep.play(stream[10:])
    assert lockstep.state() == "TRACKING"
    assert np.mean(lockstep.overlaps(stream)) > 0.5
