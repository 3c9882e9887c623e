# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import os

import numpy as np
import pytest

from het_ros.evaluation.timing import BLOCK, time_trackers
from het_ros.evaluation.trackers import Identity

from .doubles import spec, write_sequence

CALLS = []


class Marks(Identity):
    """Notes who is called when, and dies at a given update."""

    def __init__(self, name, dies_at=None):
        self.name, self.dies_at, self.updates = name, dies_at, 0

    def update(self, image, dt):
        self.updates += 1
        if self.updates == self.dies_at:
            raise RuntimeError("no more")
        CALLS.append(self.name)
        return super().update(image, dt)


class Fatal(Identity):
    def update(self, image, dt):
        os.abort()


@pytest.fixture
def still(tmp_path):
    CALLS.clear()
    return write_sequence(tmp_path / "still", [(10, 10, 10, 10)] * (2 * BLOCK + 5))


def test_trackers_take_turns_in_blocks_on_the_same_frames(still, tmp_path):
    trackers = [spec(name, lambda seed, n=name: Marks(n)) for name in ("a", "b")]
    timing = time_trackers(trackers, [still], 2 * BLOCK, tmp_path / "t", quiet=True)
    assert [*"a" * BLOCK, *"b" * BLOCK] * 2 == CALLS
    for name in ("a", "b"):
        times = timing.seconds[name, "still"]
        assert len(times) == 2 * BLOCK
        assert (times > 0).all()


def test_a_tracker_that_raises_is_timed_up_to_there(still, tmp_path):
    trackers = [spec("a", lambda seed: Marks("a", dies_at=4)), spec("b", lambda seed: Marks("b"))]
    seconds = time_trackers(trackers, [still], 8, tmp_path / "t", quiet=True).seconds
    assert np.isfinite(seconds["a", "still"]).tolist() == [True] * 3 + [False] * 5
    assert np.isfinite(seconds["b", "still"]).all()


def test_what_killed_its_process_is_not_run_again_in_this_one(still, tmp_path):
    trackers = [spec("fatal", lambda seed: Fatal()), spec("b", lambda seed: Marks("b"))]
    skipped = {("fatal", "still")}
    seconds = time_trackers(trackers, [still], 4, tmp_path / "t", skipped, quiet=True).seconds
    assert np.isnan(seconds["fatal", "still"]).all()
    assert np.isfinite(seconds["b", "still"]).all()


def test_a_comparison_is_timed_once_and_anew_when_one_of_it_changes(still, tmp_path):
    a, b, c = (spec(name, lambda seed, n=name: Marks(n)) for name in "abc")
    first = time_trackers([a, b], [still], 4, tmp_path / "t", quiet=True)
    CALLS.clear()
    again = time_trackers([a, b], [still], 4, tmp_path / "t", quiet=True)
    assert CALLS == []
    np.testing.assert_array_equal(first.seconds["a", "still"], again.seconds["a", "still"])
    time_trackers([a, c], [still], 4, tmp_path / "t", quiet=True)
    assert set(CALLS) == {"a", "c"}, "both, or the ratio would compare two days"
