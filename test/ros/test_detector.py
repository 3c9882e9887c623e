# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A detector in the loop: one that is late, misses and invents."""

import inspect
import math

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped

from het_ros import Box, Estimate, HierarchicalEnsembleTracker, State
from het_ros.ros import detector as detector_module
from het_ros.ros import tracker_node
from het_ros.ros.detector import CLICK_WAIT, MOST_CANDIDATES, Click, Detections, Detector
from het_ros.ros.detector import detections_of as boxes_of
from het_ros.ros.messages import BoxError, box_from_polygon

from .streams import FRAME_TIME, ByHand, header_at
from .test_depth_wait import Clock
from .vision import VISION

NS = 1_000_000_000
REAL = tracker_node.vision_msgs


def detections(boxes, seconds, vision=VISION):
    """A message with these boxes (x, y, w, h) of the image with that stamp, s."""
    message = vision.Detection2DArray()
    message.header = header_at(seconds)
    for x, y, w, h in boxes:
        found = vision.Detection2D()
        found.bbox.center.position.x, found.bbox.center.position.y = x + w / 2, y + h / 2
        found.bbox.size_x, found.bbox.size_y = float(w), float(h)
        message.detections.append(found)
    return message


def point(x, y, seconds=0.0):
    message = PointStamped(header=header_at(seconds))
    message.point.x, message.point.y = float(x), float(y)
    return message


@pytest.fixture
def hand(graph):
    return ByHand(graph)


@pytest.fixture
def detector():
    clock = Clock()
    made = Detector("/detections_in", clock)
    made.clock = clock
    return made


# What a message holds ------------------------------------------------------------------------


@pytest.mark.parametrize("vision", [VISION, REAL], ids=["stand-in", "real"])
def test_boxes_of_a_message(vision):
    if vision is None:
        pytest.skip("vision_msgs is not on PyPI: apt's ROS has it")
    wrong = [(math.nan, 0, 5, 5), (0, 0, 0, 5), (0, 0, math.inf, 5), (0, 0, -3, 5)]
    read = boxes_of(detections([(10, 20, 30, 40), *wrong], 2.0, vision))
    assert read == Detections(2 * NS, (Box(10, 20, 30, 40),))


# Clicks --------------------------------------------------------------------------------------

NESTED = [(10, 10, 100, 100), (20, 20, 30, 30), (25, 25, 60, 60)]


@pytest.mark.parametrize(
    "at, expected",
    [((30, 30), (20, 20, 30, 30)), ((70, 70), (25, 25, 60, 60)), ((15, 15), (10, 10, 100, 100))],
)
def test_the_smallest_around_a_click_is_taken(detector, at, expected):
    detector.take(boxes_of(detections(NESTED, 1.0)))
    box, stamp = detector.click(Click(*at, 0), 0.2)
    assert (box.as_tuple(), stamp) == (expected, NS)


def test_the_detections_of_the_clicked_image_are_taken(detector):
    for i in range(5):
        detector.take(boxes_of(detections([(10 * i, 10, 20, 20)], 1 + i / 5)))
    box, stamp = detector.click(Click(30, 15, round(1.4 * NS)), 0.2)
    assert (box.x, stamp) == (20, round(1.4 * NS))


def test_a_click_waits_for_a_detector_that_is_late(detector):
    assert detector.click(Click(15, 15, 2 * NS), 0.2) is None
    assert detector.take(boxes_of(detections([(90, 90, 9, 9)], 1.9))) is None  # it misses
    box, stamp = detector.take(boxes_of(detections([(10, 10, 20, 20)], 2.0)))
    assert (box.x, stamp) == (10, 2 * NS)
    assert detector.take(boxes_of(detections([(10, 10, 20, 20)], 2.1))) is None  # once


@pytest.mark.parametrize(
    "said, reason", [([], "nothing came on /detections_in"), ([(90, 90, 9, 9)], "has 1 elsewhere")]
)
def test_a_click_on_nothing_is_refused_in_time(detector, said, reason):
    if said:
        detector.take(boxes_of(detections(said, 1.0)))
    assert detector.click(Click(15, 15, NS), 0.2) is None
    detector.check()
    detector.clock.now += CLICK_WAIT
    with pytest.raises(BoxError, match=reason):
        detector.check()
    detector.check()  # once


def test_a_click_starts_on_the_image_of_the_detection_and_runs_forward(hand, made_footage):
    """The detection of frame 0 comes at frame 12, when the target is elsewhere."""
    frames, box = made_footage
    for i in range(13):
        hand.image(frames[i], 1 + i * FRAME_TIME)
    hand.node.starts.on_detections(detections([box, (0, 0, 160, 120)], 1.0))
    assert hand.node.state is State.IDLE  # a detection alone starts nothing
    del hand.sent[:]
    hand.node.on_init_point(point(box[0] + 5, box[1] + 5, 1.0))
    newest = dict(hand.sent)["box"]
    assert newest.header == header_at(1 + 12 * FRAME_TIME)
    assert box_from_polygon(newest).iou(Box(20 + 24, 40 + 6, 20, 32)) > 0.6


def test_a_click_on_nothing_leaves_the_track_as_it_is(hand, made_footage, monkeypatch):
    monkeypatch.setattr(detector_module, "CLICK_WAIT", 0.0)
    frames, box = made_footage
    hand.image(frames[0], 1.0)
    hand.box(box)
    hand.node.starts.on_detections(detections([(100, 60, 20, 20)], 1.0))
    for at in ((5, 5), (math.nan, 5)):
        hand.node.on_init_point(point(*at, 1.0))
        hand.node.starts.look()
    assert hand.state_of(hand.image(frames[1], 1 + FRAME_TIME)) == "TRACKING"


def test_without_vision_msgs_a_click_says_what_to_install(hand, capfd):
    if REAL is not None:
        pytest.skip("vision_msgs is installed here")
    hand.node.on_init_point(point(5, 5))
    assert "sudo apt install ros-jazzy-vision-msgs" in capfd.readouterr().err


# While the target is hidden ------------------------------------------------------------------


class Scripted:
    """A tracker whose states are given; keeps the candidates of each frame."""

    states: tuple[State, ...] = ()
    seen: tuple[tuple[Box, ...], ...] = ()

    def __init__(self, config):
        Scripted.seen = ()

    def init(self, image, box):
        self.box = box
        return self._estimate(State.TRACKING)

    def update(self, image, dt, witness=None, **more):
        assert "candidates" not in more or more["candidates"]  # only where there are any
        state = Scripted.states[len(Scripted.seen)]
        Scripted.seen += (tuple(more.get("candidates", ())),)
        return self._estimate(state)

    def _estimate(self, state):
        return Estimate(self.box, (0.0, 0.0), np.eye(4), 0.5, state)


def test_detections_are_looked_at_first_while_the_target_is_hidden(
    hand, made_footage, monkeypatch
):
    monkeypatch.setattr("het_ros.ros.session.HierarchicalEnsembleTracker", Scripted)
    frames, _ = made_footage
    seen, coasted, lost = State.TRACKING, State.COASTING, State.LOST
    Scripted.states = (seen, coasted, coasted, coasted, lost, seen, seen)
    near, nearer, far = (50, 50, 20, 20), (45, 40, 20, 20), (400, 400, 20, 20)
    large = (30, 30, 90, 90)
    hand.image(frames[0], 1.0)
    hand.box((40, 40, 20, 20))
    for i in range(1, 8):
        if i != 4:  # it misses one
            boxes = [near, large, nearer, far] if i != 3 else []
            hand.node.starts.on_detections(detections(boxes, 1 + (i - 1) * FRAME_TIME))
        hand.image(frames[i], 1 + i * FRAME_TIME)
    both = (Box(*nearer), Box(*near))  # the nearest first; neither the large nor the far one
    assert Scripted.seen == ((), (), (), (), both, both, ())


@pytest.mark.parametrize("late, count", [(0.0, 1), (0.9, 1), (1.1, 0), (-2.0, 0)])
def test_detections_that_are_too_late_are_no_candidates(detector, late, count):
    detector.take(boxes_of(detections([(40, 40, 20, 20)], 5.0)))
    assert len(detector.near(Box(40, 40, 20, 20), 0.0, round((5 + late) * NS))) == count


@pytest.mark.parametrize("hidden, count", [(0.0, 0), (1.0, 1)])
def test_the_longer_it_is_hidden_the_farther_it_may_be(detector, hidden, count):
    detector.take(boxes_of(detections([(90, 40, 20, 20)], 5.0)))
    assert len(detector.near(Box(40, 40, 20, 20), hidden, 5 * NS)) == count


def test_who_invents_many_is_heard_in_part(detector):
    detector.take(boxes_of(detections([(40 + i / 10, 40, 20, 20) for i in range(1000)], 5.0)))
    found = detector.near(Box(40, 40, 20, 20), 0.0, 5 * NS)
    assert len(found) == MOST_CANDIDATES and found[0].x == 40


def test_time_that_goes_back_forgets_detections(detector):
    detector.take(boxes_of(detections([(40, 40, 20, 20)], 50.0)))
    detector.take(boxes_of(detections([], 5.0)))
    assert not detector.near(Box(40, 40, 20, 20), 0.0, 50 * NS)


@pytest.mark.skipif(
    "candidates" not in inspect.signature(HierarchicalEnsembleTracker.update).parameters,
    reason="this core takes no candidates",
)
def test_a_target_is_never_where_a_detector_says_so_alone(hand, made_footage):
    """The target is gone, and the detector invents one beside its last place."""
    frames, box = made_footage
    hand.image(frames[0], 1.0)
    hand.box(box)
    for i in range(1, 10):
        hand.image(frames[i], 1 + i * FRAME_TIME)
    ground = np.full_like(frames[0], 127)
    for i in range(10, 120):
        hand.node.starts.on_detections(detections([(45, 50, 20, 32)], 1 + (i - 6) * FRAME_TIME))
        state = hand.state_of(hand.image(ground, 1 + i * FRAME_TIME))
        assert i < 13 or state != "TRACKING"
    assert state == "LOST"
