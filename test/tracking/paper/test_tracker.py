# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box, State
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.paper.tracker import PaperTracker

DT = 1 / 30
PAPER = PaperConfig()


def started(image, box, config=PAPER):
    tracker = PaperTracker(config)
    tracker.init(image, box)
    return tracker


def track(frames, config, count):
    tracker = PaperTracker(config)
    estimates = [tracker.init(frames.image(0), frames.boxes[0])]
    return estimates + [tracker.update(frames.image(i), DT) for i in range(1, count)]


def same(a, b):
    return (
        (a.box, a.velocity, a.score, a.state, a.patches)
        == (b.box, b.velocity, b.score, b.state, b.patches)
    ) and np.array_equal(a.covariance, b.covariance)


@pytest.mark.parametrize("seed", [0, 1])
def test_follows_a_real_pedestrian(sequence, seed):
    frames = sequence("Crossing")
    estimates = track(frames, PaperConfig(seed=seed), len(frames.boxes))
    overlaps = [e.box.iou(box) for e, box in zip(estimates, frames.boxes, strict=True)]
    assert np.mean(overlaps) > 0.55
    assert all(e.state is State.TRACKING for e in estimates)


def test_same_seed_same_result_to_the_bit(sequence):
    frames = sequence("Crossing")
    once, again, other = (track(frames, PaperConfig(seed=seed), 12) for seed in (7, 7, 8))
    assert all(map(same, once, again))
    assert not all(map(same, once, other))


def test_an_estimate_says_all_it_promises(sequence):
    frames = sequence("Crossing")
    first, *_, last = track(frames, PAPER, 30)
    assert first.box == frames.boxes[0]
    assert first.patches == ()
    assert len(last.patches) == PAPER.sub_patches
    assert 0 <= last.score <= 1
    assert last.covariance.shape == (4, 4)
    assert (np.linalg.eigvalsh(last.covariance) > 0).all()
    for patch in last.patches:
        assert (patch.box.w, patch.box.h) == (13, 38)
        assert 0.1 <= patch.weight <= 0.9 + 1e-12
        assert patch.box.intersection(last.box) > 0


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


def test_nothing_to_see_leaves_the_box_where_it_is():
    flat = np.full((120, 160, 3), 77, np.uint8)
    tracker = started(flat, Box(60, 40, 20, 30))
    for _ in range(5):
        estimate = tracker.update(flat, DT)
    assert estimate.box == Box(60, 40, 20, 30)
    assert estimate.score == 0.5


@pytest.mark.parametrize("gray", [False, True], ids=["colour", "gray"])
@pytest.mark.parametrize(
    ("box", "within"),
    [
        (Box(0, 0, 160, 120), 1),
        (Box(-100, -100, 400, 400), 1),
        (Box(50, 50, 4, 4), 4),
        # One px cannot be told from others: it may go as far as it is searched for.
        (Box(50.5, 50.5, 1, 1), 3 * PAPER.search_radius),
        (Box(50, 50, 0.4, 0.4), 3 * PAPER.search_radius),
        (Box(-15, -20, 30, 40), 2),
        (Box(150, 110, 30, 40), 2),
        (Box(0, 50, 160, 1), 2),
    ],
    ids=str,
)
def test_boxes_of_all_sizes_and_over_the_border(noise, box, within, gray):
    image = noise[:, :, 0].copy() if gray else noise
    tracker = started(image, box)
    for _ in range(3):
        estimate = tracker.update(image, DT)
        assert (estimate.box.w, estimate.box.h) == pytest.approx((box.w, box.h))
        assert np.isfinite(estimate.covariance).all()
    np.testing.assert_allclose(estimate.box.centre, box.centre, atol=within)


def test_a_box_outside_the_image_is_lost_until_the_next_box(noise):
    tracker = started(noise, Box(120, 80, 20, 30))
    assert tracker.update(noise, DT).state is State.TRACKING
    lost = tracker.update(noise[:60, :80], DT)
    assert (lost.state, lost.score, lost.patches) == (State.LOST, 0.0, ())
    assert tracker.update(noise, DT).state is tracker.state is State.LOST
    assert tracker.init(noise, Box(20, 40, 20, 30)).state is State.TRACKING
    assert tracker.update(noise, DT).state is tracker.state is State.TRACKING


@pytest.mark.parametrize(
    "other",
    [
        lambda image: image[:, :, 1].copy(),
        lambda image: image[:100, :110],
        lambda image: np.pad(image, ((0, 60), (0, 90), (0, 0))),
        lambda image: image[::-1, ::-1],
    ],
    ids=["gray", "smaller", "larger", "a view with negative strides"],
)
def test_images_may_change_their_kind_and_size(noise, other):
    tracker = started(noise, Box(60, 40, 20, 30))
    changed = other(noise)
    assert tracker.update(changed, DT).state is State.TRACKING
    assert tracker.update(noise, DT).state is State.TRACKING


def test_images_are_left_as_they_are(noise):
    before = noise.copy()
    noise.setflags(write=False)
    tracker = started(noise, Box(60, 40, 20, 30))
    tracker.update(noise, DT)
    np.testing.assert_array_equal(noise, before)


@pytest.mark.parametrize("dt", [0.0, -3.0, 1e9, 1e-12])
def test_any_time_step_is_survived(noise, dt):
    tracker = started(noise, Box(60, 40, 20, 30))
    for _ in range(5):
        estimate = tracker.update(noise, dt)
    assert np.isfinite(estimate.covariance).all()
    np.testing.assert_allclose(estimate.box.as_tuple(), (60, 40, 20, 30), atol=2)


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
    tracker = PaperTracker(PAPER)
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


def test_a_witness_and_candidates_are_not_asked(noise):
    alone, asked = (started(noise, Box(60, 40, 20, 30)) for _ in range(2))
    denied = asked.update(noise, DT, witness=lambda box: False, candidates=(Box(1, 1, 9, 9),))
    assert same(alone.update(noise, DT), denied)


@pytest.mark.parametrize("sides", [(1.0, 1.0), (0.4, 30.0), (30.0, 0.6), (1e-6, 1e-6)])
def test_boxes_smaller_than_a_pixel(noise, sides):
    tracker = started(noise, Box(50, 50, *sides), PaperConfig(features=20, search_radius=8.0))
    for _ in range(3):
        estimate = tracker.update(noise, DT)
        assert np.isfinite([*estimate.box.as_tuple(), estimate.score]).all()
        assert (estimate.box.w, estimate.box.h) == pytest.approx(sides)


@pytest.mark.parametrize("box", [Box(-1000, -1000, 3000, 3000), Box(-1e6, 40, 2e6, 2)])
def test_what_would_take_too_much_memory_is_refused_and_the_track_goes_on(noise, box):
    tracker = started(noise, Box(60, 40, 20, 30))
    with pytest.raises(ValueError, match="most_memory"):
        tracker.init(noise, box)
    np.testing.assert_allclose(tracker.update(noise, DT).box.as_tuple(), (60, 40, 20, 30), atol=1)
