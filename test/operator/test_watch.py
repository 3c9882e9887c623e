# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Box, velocity and status of a frame, whatever order they come in."""

from __future__ import annotations

import itertools

import pytest

from het_ros.operator.watch import Tracks

STATUS = {"state": "TRACKING", "score": 0.9}
PARTS = ({"box": [1, 2, 3, 4]}, {"velocity": [5, 6]}, STATUS)


@pytest.mark.parametrize("order", list(itertools.permutations(PARTS)))
def test_a_frame_is_told_when_its_last_part_has_come(order):
    tracks = Tracks()
    told = [tracks.add(7, **parts) for parts in order]
    assert told[:2] == [[], []]
    ((message,),) = told[2:]
    assert (message["stamp"], message["box"], message["velocity"]) == ("7", [1, 2, 3, 4], [5, 6])
    assert tracks.state == "TRACKING"


@pytest.mark.parametrize("state", ["IDLE", "LOST"])
def test_without_a_box_the_status_is_all(state):
    (message,) = Tracks().add(7, state=state, score=0.0)
    assert (message["box"], message["velocity"]) == (None, None)


def test_a_part_that_got_lost_holds_up_nothing():
    tracks = Tracks()
    assert tracks.add(7, box=[1, 2, 3, 4]) == []
    assert tracks.add(8, **STATUS) == []
    told = [message for parts in PARTS for message in tracks.add(9, **parts)]
    assert [message["stamp"] for message in told] == ["8", "9"]


def test_parts_without_a_status_are_not_kept_for_ever():
    tracks = Tracks()
    for stamp in itertools.chain(range(100), range(50)):
        tracks.add(stamp, box=[1, 2, 3, 4])
    assert len(tracks._pending) <= 5
