# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np

from het_ros import Box, HierarchicalEnsembleTracker, TrackerConfig
from het_ros.evaluation import fit
from het_ros.evaluation.fit import Recorded
from het_ros.evaluation.readers import read_sequences
from het_ros.tracking.fitted import FITTED


def test_a_run_is_recorded_frame_by_frame(moving):
    frames = list(fit.frames_of(moving))
    frames[-3:] = [(image, None) for image, _ in frames[-3:]]
    start = Box(*moving.truth[0])
    found = fit.recorded("moving", "g", iter(frames), start, 1 / 30, TrackerConfig(), FITTED)
    rows = found.rows[fit.WITHOUT]
    assert rows.shape == (11, 7)
    assert found.frames == 11
    assert rows[-3:, -1].tolist() == [0, 0, 0], "a box on an absent target is wrong"

    tracker = HierarchicalEnsembleTracker(TrackerConfig())
    tracker.init(frames[0][0], start)
    for (image, truth), row in zip(frames[1:], rows, strict=True):
        box = tracker.update(image, 1 / 30).box
        known = tracker.target.confidence.features
        assert known.clipped() == tuple(row[:-1])
        if truth and not tracker.target.confidence.unseen:
            assert row[-1] == (box.iou(truth) > 0.5)


def test_targets_in_one_picture_are_held_out_together(data):
    found = read_sequences(data, ("Crossing", "Jogging-1", "Jogging-2"))
    groups = fit.groups_of(found)
    assert groups["Jogging-1"] == groups["Jogging-2"] != groups["Crossing"]


def test_starts_are_as_given_and_off_by_a_tenth():
    box = Box(10, 20, 40, 30)
    starts = fit.given_boxes(box, 2, 3, turn=4)
    assert [seed for seed, _ in starts] == [0, 1, 0, 1, 2]
    assert [start == box for _, start in starts] == [True, True, False, False, False]
    for turn in range(10):
        ((_, off),) = fit.given_boxes(box, 0, 1, turn)
        change = np.array(off.centre) - box.centre
        assert np.allclose(np.abs(change / (4, 3)).round(6) % 1, 0)
        assert 0.89 < off.w / box.w < 1.11
        assert off != box


def test_the_order_of_the_runs_makes_no_difference():
    rng = np.random.default_rng(0)
    runs = [Recorded(name, name, 5, {fit.WITHOUT: rng.random((5, 7))}) for name in ("a", "b", "a")]
    one, other = fit.examples(runs, fit.WITHOUT), fit.examples(runs[::-1], fit.WITHOUT)
    assert np.array_equal(one.features, other.features)
    assert one.sequences.tolist() == ["a"] * 10 + ["b"] * 5
