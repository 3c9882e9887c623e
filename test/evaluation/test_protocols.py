# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import sys

import numpy as np
import pytest

from het_ros.evaluation import protocols
from het_ros.evaluation.answers import Answer
from het_ros.evaluation.metrics import score
from het_ros.evaluation.protocols import disturbed, follow, follow_camera, follow_restarting
from het_ros.evaluation.restarts import summarise
from het_ros.evaluation.runs import Plan, Run
from het_ros.evaluation.trackers import Identity
from het_ros.tracking.box import Box

from .doubles import Oracle, Scripted, spec, write_sequence


def first_box(sequence):
    return Box(*sequence.truth[0])


def test_the_oracle_is_perfect_and_the_identity_gets_what_arithmetic_says(moving):
    oracle = follow(Oracle(moving.truth, 0), moving.frames, first_box(moving))
    assert score(oracle.boxes, moving.truth).auc == pytest.approx(20 / 21)
    still = follow(Identity(), moving.frames, first_box(moving))
    # The square of 10 x 12 px moves 3 px a frame: after k frames max(10 - 3 k, 0) columns of 10
    # are shared, so the overlap is s / (20 - s).
    shared = np.clip(10 - 3 * np.arange(12), 0, None)
    result = score(still.boxes, moving.truth)
    assert result.mean_overlap == pytest.approx((shared / (20 - shared)).mean())
    assert result.p20 == pytest.approx(7 / 12)  # errors 0, 3, ... 18 px


class Spy:
    """Looks for the truth wherever a tracker can look: its arguments and the calling frames."""

    def __init__(self, truth):
        self.truth = truth
        self.found = []

    def init(self, *arguments):
        self.box = arguments[1].as_tuple()
        assert len(arguments) == 2
        self.look(arguments)

    def update(self, *arguments):
        assert [type(a) for a in arguments] == [np.ndarray, float]
        self.look(arguments)
        return Answer(self.box)

    def look(self, arguments):
        """Record every later true box that can be reached, some levels deep."""
        here = list(arguments)
        frame = sys._getframe(2)
        while frame.f_code.co_filename == protocols.__file__:
            here += frame.f_locals.values()
            frame = frame.f_back
        self.found += [box for value in here for box in self.reachable(value, 4)]

    def reachable(self, value, depth):
        if value is self or value is None or isinstance(value, (str, int, float, bytes)):
            return []
        if isinstance(value, np.ndarray):
            rows = value.reshape(-1, 4) if value.size % 4 == 0 and value.ndim <= 2 else value[:0]
            later = self.truth[1:]
            return [r for r in rows if r.size == 4 and (np.abs(later - r).sum(axis=1) == 0).any()]
        if isinstance(value, Box):
            return self.reachable(np.array(value.as_tuple()), 0)
        if depth == 0:
            return []
        inside = list(vars(value).values()) if hasattr(value, "__dict__") else []
        if isinstance(value, dict):
            inside += value.values()
        elif isinstance(value, (list, tuple, set)):
            inside += value
        return [box for item in inside for box in self.reachable(item, depth - 1)]


@pytest.mark.parametrize("run", [follow, lambda t, f, b: follow_camera(t, f, b, 30.0)])
def test_a_spying_tracker_finds_no_truth(run, moving):
    spy = Spy(moving.truth)
    run(spy, moving.frames, first_box(moving))
    assert spy.found == []


def test_the_spy_would_find_the_truth_if_it_were_there(moving):
    spy = Spy(moving.truth)
    assert spy.reachable({"sequence": moving}, 4), "or the test above proves nothing"


def test_a_restart_gives_the_tracker_images_and_start_boxes_only(moving):
    seen = []

    class Arguments(Scripted):
        def init(self, *arguments):
            seen.append(arguments)
            super().init(*arguments)

        def update(self, *arguments):
            seen.append(arguments)
            return super().update(*arguments)

    follow_restarting(Arguments(moving.truth), moving.frames, moving.truth)
    assert [type(a) for a in seen[0]] == [np.ndarray, Box]
    assert all([type(a) for a in call] == [np.ndarray, float] for call in seen[1:])
    assert len(seen) == len(moving.frames)


@pytest.mark.parametrize("protocol", ["ope", "tre", "sre", "passes", "half_rate", "realtime"])
def test_jobs_hold_no_truth_but_their_own_start(protocol, moving):
    tracker = spec("identity", Identity)
    for job, rows in Plan([tracker], [moving], protocol).jobs():
        assert job.referee is None
        assert job.box == first_box(moving) or protocol in ("tre", "sre", "passes")
        spy = Spy(moving.truth)
        others = [r for r in spy.reachable(job, 4) if tuple(r) != tuple(moving.truth[rows][0])]
        assert others == []


def test_tre_starts_20_times_at_frames_that_have_a_box(tmp_path):
    boxes = [None if 8 <= i < 12 else (5, 5, 10, 10) for i in range(40)]
    sequence = write_sequence(tmp_path / "gap", boxes)
    starts = protocols.starts("tre", sequence)
    assert [s.first for s in starts[:6]] == [0, 2, 4, 6, 12, 14]
    assert len(starts) == 18, "starts that fall together count once"
    assert all(sequence.visible[s.first] for s in starts)


def test_passes_are_the_same_frames_in_five_orders(moving):
    starts = protocols.starts("passes", moving)
    rows = [list(range(12)[start.rows]) for start in starts]
    assert rows == [
        list(range(12)),
        list(range(11, -1, -1)),
        list(range(4, 12)),
        list(range(7, -1, -1)),
        list(range(0, 12, 2)),
    ]
    for start, taken in zip(starts, rows, strict=True):
        assert start.box == protocols.true_box(moving, taken[0])
        files = [moving.frames.files[i] for i in taken]
        assert list(moving.frames.taken(start.rows).files) == files


def test_at_half_the_rate_a_frame_lasts_twice_as_long(moving):
    (start,) = protocols.starts("half_rate", moving)
    frames = moving.frames.taken(start.rows)
    assert frames.files == moving.frames.files[::2]
    assert frames.dt == 2 * moving.frames.dt


def test_passes_start_where_the_target_is_in_sight(tmp_path):
    boxes = [None if i in (4, 7, 11) else (5, 5, 10, 10) for i in range(12)]
    boxes[0] = (5, 5, 10, 10)
    starts = protocols.starts("passes", write_sequence(tmp_path / "gap", boxes))
    assert [(s.first, s.step) for s in starts] == [(0, 1), (10, -1), (5, 1), (6, -1), (0, 2)]


def test_tre_on_a_short_sequence_starts_at_every_frame(moving):
    assert [s.first for s in protocols.starts("tre", moving)] == list(range(12))


def test_sre_disturbs_the_box_in_12_ways():
    box = Box(100, 200, 40, 20)
    boxes = disturbed(box)
    assert len(set(boxes)) == 12
    assert [b.w for b in boxes[8:]] == pytest.approx([32, 36, 44, 48])
    assert [b.h for b in boxes[8:]] == pytest.approx([16, 18, 22, 24])
    shifts = {(round(b.x - box.x, 6), round(b.y - box.y, 6)) for b in boxes[:8]}
    assert shifts == {(4 * i, 2 * j) for i in (-1, 0, 1) for j in (-1, 0, 1)} - {(0, 0)}
    assert all(b.centre == pytest.approx(box.centre) for b in boxes[8:])


class Slow(Scripted):
    """Takes a scripted time, by moving the clock, and returns the number of its update as x."""

    def __init__(self, clock, seconds):
        self.clock, self.seconds, self.dts = clock, seconds, []

    def init(self, image, box):
        self.calls = 0

    def update(self, image, dt):
        self.clock.now += self.seconds
        self.calls += 1
        self.dts.append(dt)
        return Answer((float(self.calls), 0, 10, 10))


@pytest.mark.parametrize(
    ("busy", "answers"),
    [
        # Frames come every 0.1 s. Frame 0 is the start (x of the first box: 5).
        (0.05, [5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]),  # fast enough: every frame
        (0.15, [5, 1, 2, 2, 3, 4, 4, 5, 6, 6, 7, 8]),  # 2 of 3 frames
        (0.25, [5, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5]),
        (10.0, [5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]),
    ],
)
def test_frames_that_pass_while_the_tracker_is_busy_get_its_last_answer(
    monkeypatch, moving, busy, answers
):
    class Clock:
        now = 0.0

        def perf_counter(self):
            return self.now

    clock = Clock()
    monkeypatch.setattr(protocols, "time", clock)
    tracker = Slow(clock, busy)
    track = follow_camera(tracker, moving.frames, first_box(moving), camera=10.0)
    assert track.boxes[:, 0].tolist() == answers
    seen = np.flatnonzero(np.isfinite(track.seconds))
    assert tracker.dts == pytest.approx(np.diff(seen) / 10.0), "dt is the time between its frames"


def test_restarts_count_failures_and_leave_out_the_burn_in(tmp_path):
    truth = [(10, 10, 10, 10)] * 40
    sequence = write_sequence(tmp_path / "still", truth)
    away = Answer((200.0, 10, 10, 10))
    half = Answer((10.0, 10, 10, 20))  # overlap 0.5

    class Fails(Scripted):
        """Half right, and wrong at the 15th update after each start."""

        def update(self, image, dt):
            self.row += 1
            return away if self.row == 15 else half

    track = follow_restarting(Fails([]), sequence.frames, sequence.truth)
    assert track.failures == [15, 35]
    assert track.starts == [0, 20]
    run = Run("x", "still", 0, "restart", slice(0, None), track)
    result = summarise([run], {"still": sequence.truth})
    assert result["accuracy"] == pytest.approx(0.5)
    assert result["failures"] == 2
    assert result["failures_per_100"] == pytest.approx(5)
    assert result["reliability"] == pytest.approx(np.exp(-5))


def test_a_tracker_that_raises_is_started_anew_and_the_error_kept(tmp_path):
    sequence = write_sequence(tmp_path / "still", [(10, 10, 10, 10)] * 12)

    class Raises(Identity):
        def init(self, image, box):
            super().init(image, box)
            self.calls = 0

        def update(self, image, dt):
            self.calls += 1
            if self.calls == 2:
                raise RuntimeError("no more")
            return super().update(image, dt)

    track = follow_restarting(Raises(), sequence.frames, sequence.truth)
    assert (track.starts, track.failures) == ([0, 7], [2, 9])
    assert track.error == "frame 2: RuntimeError: no more"


def test_an_absent_target_is_no_failure(tmp_path):
    boxes = [(10, 10, 10, 10), None, None, (10, 10, 10, 10)]
    sequence = write_sequence(tmp_path / "gone", boxes)
    track = follow_restarting(Identity(), sequence.frames, sequence.truth)
    assert (track.failures, track.starts) == ([], [0])


def test_a_tracker_that_raises_is_scored_with_its_last_box(moving):
    class Raises(Identity):
        def update(self, image, dt):
            raise RuntimeError("no more")

    track = follow(Raises(), moving.frames, first_box(moving))
    assert track.error == "frame 1: RuntimeError: no more"
    np.testing.assert_array_equal(track.boxes, np.tile(moving.truth[0], (12, 1)))


def test_a_tracker_without_an_answer_keeps_its_box(moving):
    class Lost(Identity):
        def update(self, image, dt):
            return Answer(None, "LOST")

    track = follow(Lost(), moving.frames, first_box(moving))
    assert track.error == ""
    np.testing.assert_array_equal(track.boxes, np.tile(moving.truth[0], (12, 1)))
