# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What every use of the tracker may count on: calls, states, refusals."""

import cv2
import numpy as np
import pytest

from het_ros import Box, HierarchicalEnsembleTracker, State, TrackerConfig

DT = 1 / 30


def started(image, box, config=None):
    tracker = HierarchicalEnsembleTracker(config)
    tracker.init(image, box)
    return tracker


def same(a, b):
    return (
        (a.box, a.velocity, a.score, a.state, a.patches)
        == (b.box, b.velocity, b.score, b.state, b.patches)
    ) and np.array_equal(a.covariance, b.covariance)


def test_a_target_that_stands_still_stays(noise):
    tracker = started(noise, Box(60.3, 40.6, 21, 33))
    for _ in range(10):
        estimate = tracker.update(noise, DT)
    np.testing.assert_allclose(estimate.box.as_tuple(), (60.3, 40.6, 21, 33), atol=1)
    np.testing.assert_allclose(estimate.velocity, 0, atol=3)


def test_velocity_is_in_pixels_a_second(noise):
    tracker = started(noise, Box(30, 40, 21, 33))
    for i in range(1, 16):
        estimate = tracker.update(np.roll(noise, 2 * i, axis=1), 0.1)
    np.testing.assert_allclose(estimate.box.as_tuple(), (60, 40, 21, 33), atol=1.5)
    np.testing.assert_allclose(estimate.velocity, [20, 0], atol=4)


def test_what_a_witness_denies_is_hidden_and_not_learnt(noise):
    tracker = started(noise, Box(60, 40, 21, 33))
    asked = []
    for _ in range(5):
        estimate = tracker.update(noise, DT, witness=lambda box: bool(asked.append(box)))
        assert estimate.state is State.COASTING
        assert estimate.score <= 0.5
        assert estimate.patches == ()
    assert len(asked) == 5
    assert asked[0].iou(Box(60, 40, 21, 33)) > 0.9  # asked of what was found in the image
    estimate = tracker.update(noise, DT, witness=lambda box: True)
    assert estimate.state is State.TRACKING


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (np.zeros((20, 20, 3), np.float32), "uint8 array, not float32"),
        (np.zeros((20, 20, 4), np.uint8), r"\(20, 20, 4\)"),
        (np.zeros((20, 20, 3, 1), np.uint8), "shape"),
        (np.zeros((0, 20), np.uint8), r"\(0, 20\)"),
        ([[1, 2], [3, 4]], "not list"),
        (None, "not NoneType"),
    ],
)
def test_what_is_no_image_is_refused_and_the_track_goes_on(noise, image, says):
    tracker = started(noise, Box(60, 40, 20, 30))
    with pytest.raises(ValueError, match=says):
        tracker.init(image, Box(1, 1, 9, 9))
    with pytest.raises(ValueError, match=says):
        tracker.update(image, DT)
    assert tracker.state is State.TRACKING
    np.testing.assert_allclose(tracker.update(noise, DT).box.as_tuple(), (60, 40, 20, 30), atol=1)


def test_a_box_outside_the_image_is_refused_and_the_track_goes_on(noise):
    tracker = started(noise, Box(60, 40, 20, 30))
    with pytest.raises(ValueError, match="wholly outside the image of 160 x 120"):
        tracker.init(noise, Box(160, 0, 20, 30))
    np.testing.assert_allclose(tracker.update(noise, DT).box.as_tuple(), (60, 40, 20, 30), atol=1)


@pytest.mark.parametrize("dt", [float("nan"), float("inf"), float("-inf")])
def test_a_time_step_that_is_no_number_is_refused(noise, dt):
    tracker = started(noise, Box(60, 40, 20, 30))
    with pytest.raises(ValueError, match="finite number of seconds"):
        tracker.update(noise, dt)


def test_states_from_idle_and_back(noise):
    tracker = HierarchicalEnsembleTracker()
    assert tracker.state is State.IDLE
    with pytest.raises(RuntimeError, match="call init first"):
        tracker.update(noise, DT)
    tracker.init(noise, Box(60, 40, 20, 30))
    assert tracker.state is State.TRACKING
    tracker.reset()
    assert tracker.state is State.IDLE
    with pytest.raises(RuntimeError, match="call init first"):
        tracker.update(noise, DT)


def test_a_second_box_starts_afresh(noise):
    tracker = started(noise, Box(60, 40, 20, 30))
    tracker.update(noise, DT)
    tracker.init(noise, Box(20, 70, 25, 25))
    fresh = started(noise, Box(20, 70, 25, 25))
    assert same(tracker.update(noise, DT), fresh.update(noise, DT))


def test_a_hidden_target_is_looked_for_where_candidates_are(noise):
    """It comes back far away, at a place that another detector names."""
    target = cv2.resize(noise[::-1, ::-1], (21, 33), interpolation=cv2.INTER_AREA)
    calm = cv2.GaussianBlur(np.tile(noise, (3, 4, 1)), (0, 0), 8)

    def at(x, y):
        image = calm.copy()
        image[y : y + 33, x : x + 21] = target
        return image

    found = {}
    for name, candidates in (("named", (Box(520, 290, 21, 33),)), ("not named", ())):
        tracker = started(at(60, 40), Box(60, 40, 21, 33), TrackerConfig(colour_weight=0.0))
        for _ in range(12):
            tracker.update(at(60, 40), DT)
        for _ in range(4):
            assert tracker.update(calm, DT).state is not State.TRACKING
        for _ in range(3):
            estimate = tracker.update(at(515, 285), DT, candidates=candidates)
        found[name] = estimate.state is State.TRACKING and estimate.box.iou(Box(515, 285, 21, 33))
    assert found["named"] > 0.5
    assert not found["not named"]
