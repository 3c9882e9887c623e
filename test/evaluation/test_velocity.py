# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box, Estimate, State
from het_ros.evaluation import velocity
from het_ros.evaluation.answers import HORIZONS, Answer, Track
from het_ros.evaluation.runs import Run
from het_ros.evaluation.sequences import Frames
from het_ros.evaluation.trackers import predicted

DT, N = 0.1, 80
FRAMES = {"s": Frames(("",) * N, 1 / DT)}


def swing(late=0.0):
    """Truth whose centre swings by 30 px in x: (n, 4)."""
    t = np.arange(N) - late
    truth = np.tile([100.0, 50.0, 40.0, 10.0], (N, 1))
    truth[:, 0] += 30 * np.sin(2 * np.pi * t / 32)
    return truth


def track_of(truth, velocities, boxes=None, state="TRACKING", covariance=None):
    track = Track.empty(len(truth))
    track.boxes[:] = truth if boxes is None else boxes
    track.velocities[1:] = velocities[1:]
    track.states[1:] = state
    if covariance is not None:
        track.velocity_covariances[1:] = covariance
    return track


def test_publishing_zero_is_as_wrong_as_zero_and_does_not_change():
    truth = swing()
    found = velocity.judge(track_of(truth, np.zeros((N, 2))), truth, DT)
    assert found["published"] == found["zero"] > 0.5
    assert found["change"] == 0
    assert found["lag"] is None
    assert found["frames"] == N - 10


def test_the_true_velocity_is_without_error_or_lag_and_changes_as_the_truth():
    truth = swing()
    true = velocity.derivative_of(truth, DT)
    found = velocity.judge(track_of(truth, true, covariance=np.eye(2)), truth, DT)
    assert found["published"] == pytest.approx(0)
    assert found["change"] == pytest.approx(found["true_change"])
    assert found["lag"] == pytest.approx(0, abs=0.05)
    assert found["within_95"] == 1
    speed = np.sqrt((true[5:-5] ** 2).sum(axis=1).mean())
    assert found["zero"] == pytest.approx(speed / 20), "in sides: sqrt(40 * 10) px"


def test_a_late_velocity_has_its_lag():
    truth = swing()
    late = velocity.derivative_of(swing(late=2.5), DT)
    late[np.isnan(late)] = 0
    found = velocity.judge(track_of(truth, late), truth, DT)
    assert found["lag"] == pytest.approx(2.5, abs=0.2)


def test_differences_of_true_boxes_are_half_a_frame_late():
    truth = swing()
    steps = np.diff(truth[:, :2], axis=0, prepend=np.nan) / DT
    found = velocity.judge(track_of(truth, steps), truth, DT)
    assert found["published"] == pytest.approx(found["differences"])
    assert found["lag"] == pytest.approx(0.5, abs=0.1)


def test_only_frames_on_the_target_and_not_lost_count():
    truth = swing()
    velocities = velocity.derivative_of(truth, DT)
    boxes, states = truth.copy(), np.full(N, "TRACKING", "<U8")
    boxes[20:30] += 500
    states[40:50] = "LOST"
    velocities[20:30] = velocities[40:50] = 1e6
    track = track_of(truth, velocities, boxes)
    track.states[:] = states
    found = velocity.judge(track, truth, DT)
    assert found["frames"] == N - 10 - 20
    assert found["published"] == pytest.approx(0)
    assert found["filter"] < 100, "in LOST there is no box that a filter could take"


def test_an_exact_truth_stands_for_the_derivative_where_it_is_given():
    truth, exact = swing(), np.tile([20.0, 0.0], (N, 1))
    found = velocity.judge(track_of(truth, exact), truth, DT, exact)
    assert (found["frames"], found["published"]) == (N - 1, 0)
    assert found["zero"] == pytest.approx(1)


def test_too_few_frames_are_not_judged():
    truth = swing()[:25]
    assert velocity.judge(track_of(truth, np.ones((25, 2))), truth, DT) is None


@pytest.mark.parametrize("own", [True, False])
def test_prediction_of_velocity_two_boxes_and_its_own(own):
    truth = np.tile([0.0, 0.0, 20.0, 20.0], (N, 1))
    truth[:, 0] = 4.0 * np.arange(N)  # 40 px/s, 2 sides/s
    track = track_of(truth, np.tile([40.0, 0.0], (N, 1)))
    if own:
        shifts = np.array(HORIZONS)[None, :, None] * [30.0, 0.0]
        track.predictions[:] = (truth[:, :2] + 10)[:, None] + shifts
    ahead = velocity.judge(track, truth, DT)["ahead"]
    assert list(ahead) == ["0.1", "0.2", "0.5"]
    assert ahead["0.5"]["stays"] == pytest.approx(1.0)
    assert ahead["0.5"]["two_boxes"] == pytest.approx(0, abs=1e-9)
    assert ahead["0.5"]["velocity"] == pytest.approx(0, abs=1e-9)
    assert ahead["0.5"]["own"] == (pytest.approx(0.25) if own else None)


def test_seeds_are_averaged_and_silent_trackers_left_out():
    truth = swing()
    quick, still = velocity.derivative_of(truth, DT), np.zeros((N, 2))
    runs = [
        Run("x", "s", seed, "ope", slice(0, None), track_of(truth, of))
        for seed, of in enumerate((quick, still))
    ]
    found = velocity.summarise(runs, {"s": truth}, FRAMES)["velocity"]["s"]
    assert found["published"] == pytest.approx(found["zero"] / 2)
    assert found["lag"] == pytest.approx(0, abs=0.05), "the one that is known"
    silent = Run("x", "s", 0, "ope", slice(0, None), track_of(truth, np.full((N, 2), np.nan)))
    assert velocity.summarise([silent], {"s": truth}, FRAMES) == {}


def test_at_half_the_rate_the_truth_moves_for_twice_the_time():
    truth = swing()
    rows = slice(0, None, 2)
    track = track_of(truth[rows], velocity.derivative_of(truth[rows], 2 * DT))
    run = Run("x", "s", 0, "half_rate", rows, track)
    found = velocity.summarise([run], {"s": truth}, FRAMES)["velocity"]["s"]
    assert found["published"] == pytest.approx(0, abs=1e-9)


def test_sequences_that_move():
    assert set(velocity.moving({"a": {"zero": 0.4}, "b": {"zero": 0.6}})) == {"b"}


class Predicts(Estimate):
    def predict(self, dt):
        return Box(self.box.x + 100 * dt, self.box.y, self.box.w, self.box.h)


class PredictsEstimate(Estimate):
    def predict(self, dt):
        return Predicts(Predicts.predict(self, dt), *list(vars(self).values())[1:])


@pytest.mark.parametrize("kind", [Predicts, PredictsEstimate])
def test_an_estimate_that_can_predict_is_asked(kind):
    estimate = kind(Box(0, 0, 10, 20), (0.0, 0.0), np.eye(4), 1.0, State.TRACKING)
    np.testing.assert_allclose(predicted(estimate), [(15, 10), (25, 10), (55, 10)])


def test_an_estimate_that_cannot_is_not():
    class Silent:
        box = Box(0, 0, 10, 20)

    assert predicted(Silent()) is None


def test_a_track_keeps_both_halves_of_the_covariance():
    track, covariance = Track.empty(2), np.arange(16.0).reshape(4, 4)
    track.put(1, Answer((0, 0, 1, 1), covariance=covariance, predictions=np.ones((3, 2))))
    assert track.covariances[1].tolist() == [[0, 1], [4, 5]]
    assert track.velocity_covariances[1].tolist() == [[10, 11], [14, 15]]
    assert (track.predictions[1] == 1).all()
    assert np.isnan(track.predictions[0]).all()
    track.repeat(1)
    assert np.isnan(track.velocity_covariances[1]).all()
