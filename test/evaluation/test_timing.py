# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import os
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from het_ros.evaluation.timing import BLOCK, time_trackers
from het_ros.evaluation.trackers import Identity

from .doubles import spec, write_sequence


class Marks(Identity):
    """Notes in a file who is called when, and raises at a given update."""

    def __init__(self, file, name, fails_at=None):
        self.file, self.name, self.fails_at, self.updates = Path(file), name, fails_at, 0

    def init(self, image, box):
        super().init(image, box)
        self.pid = os.getpid()

    def update(self, image, dt):
        self.updates += 1
        if self.updates == self.fails_at:
            self.fail()
        with self.file.open("a") as log:
            log.write(f"{self.name} {self.pid}\n")
        return super().update(image, dt)

    def fail(self):
        raise RuntimeError("no more")


class Fatal(Marks):
    """Dies as native code dies."""

    def fail(self):
        os.abort()


class FatalStart(Marks):
    def init(self, image, box):
        os.abort()


def build(kind, file, name, fails_at, seed):
    return kind(file, name, fails_at)


@pytest.fixture
def log(tmp_path):
    return tmp_path / "log.txt"


@pytest.fixture
def made(log):
    """Specifications of trackers that note their calls in the log."""

    def make(name, kind=Marks, fails_at=None):
        return spec(name, partial(build, kind, str(log), name, fails_at))

    return make


def called(log):
    """Names in the order of their updates; the log is emptied."""
    names = [line.split()[0] for line in log.read_text().splitlines()] if log.exists() else []
    log.unlink(missing_ok=True)
    return names


@pytest.fixture
def still(tmp_path):
    return write_sequence(tmp_path / "still", [(10, 10, 10, 10)] * (2 * BLOCK + 5))


@pytest.fixture
def again(tmp_path):
    return write_sequence(tmp_path / "again", [(10, 10, 10, 10)] * 6)


def test_trackers_take_turns_in_blocks_on_the_same_frames(made, still, log, tmp_path):
    trackers = [made("a"), made("b")]
    timing = time_trackers(trackers, [still], 2 * BLOCK, tmp_path / "t", quiet=True)
    assert called(log) == [*"a" * BLOCK, *"b" * BLOCK] * 2
    for name in ("a", "b"):
        times = timing.seconds[name, "still"]
        assert len(times) == 2 * BLOCK
        assert (times > 0).all()


def test_each_tracker_has_one_process_for_all_sequences(made, still, again, log, tmp_path):
    time_trackers([made("a"), made("b")], [still, again], 4, tmp_path / "t", quiet=True)
    processes = set(log.read_text().splitlines())
    assert len(processes) == 2
    assert str(os.getpid()) not in " ".join(processes)


def test_a_tracker_that_raises_is_timed_up_to_there(made, still, tmp_path):
    trackers = [made("a", fails_at=4), made("b")]
    seconds = time_trackers(trackers, [still], 8, tmp_path / "t", quiet=True).seconds
    assert np.isfinite(seconds["a", "still"]).tolist() == [True] * 3 + [False] * 5
    assert np.isfinite(seconds["b", "still"]).all()


@pytest.mark.parametrize("kind", [Fatal, FatalStart])
def test_a_tracker_that_kills_its_process_takes_nothing_along(
    kind, made, still, again, log, tmp_path
):
    """And the next sequence has it again: it died of this one."""
    trackers = [made("a"), made("fatal", kind, fails_at=BLOCK + 1), made("b")]
    timing = time_trackers(trackers, [still, again], 2 * BLOCK, tmp_path / "t", quiet=True)
    assert np.isnan(timing.seconds["fatal", "still"][BLOCK:]).all()
    for name in ("a", "b"):
        assert np.isfinite(timing.seconds[name, "still"]).all()
        assert np.isfinite(timing.seconds[name, "again"]).all()
    lives = kind is Fatal  # until its eleventh update; the second sequence has five
    assert np.isfinite(timing.seconds["fatal", "again"]).all() == lives


def test_what_killed_its_process_when_scored_is_not_run(made, still, log, tmp_path):
    skipped = {("fatal", "still")}
    trackers = [made("fatal", Fatal, fails_at=2), made("b")]
    seconds = time_trackers(trackers, [still], 4, tmp_path / "t", skipped, quiet=True).seconds
    assert np.isnan(seconds["fatal", "still"]).all()
    assert np.isfinite(seconds["b", "still"]).all()
    assert set(called(log)) == {"b"}


def test_a_comparison_is_timed_once_and_anew_when_one_of_it_changes(made, still, log, tmp_path):
    first = time_trackers([made("a"), made("b")], [still], 4, tmp_path / "t", quiet=True)
    called(log)
    again = time_trackers([made("a"), made("b")], [still], 4, tmp_path / "t", quiet=True)
    assert called(log) == []
    np.testing.assert_array_equal(first.seconds["a", "still"], again.seconds["a", "still"])
    time_trackers([made("a"), made("c")], [still], 4, tmp_path / "t", quiet=True)
    assert set(called(log)) == {"a", "c"}, "both, or the ratio would compare two days"
