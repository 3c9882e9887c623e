# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Boxes that come after their image, and the ring of images that they are started from."""

import numpy as np
import pytest

from het_ros import Box
from het_ros.evaluation.readers import read_sequences
from het_ros.ros.frames import Frame, FrameRing
from het_ros.ros.images import array_of
from het_ros.ros.messages import BoxError, box_from_polygon
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.pursuit import Pursuit
from het_ros.ros.stamps import SECOND
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tracking.config import TrackerConfig

from .streams import FRAME_TIME, ByHand, box_message, header_at, image_message

STEP = round(FRAME_TIME * SECOND)


def frame_of(pixels, number: int) -> Frame:
    return Frame(image_message(pixels, header_at(1 + number / 30)), SECOND + number * STEP, 0.0)


class Log(list):
    """A logger that keeps its lines."""

    def info(self, text):
        self.append(text)

    warning = error = info


def pursuit_of(**settings) -> Pursuit:
    return Pursuit(TrackerConfig(), NodeConfig(**settings), Log())


def run(pursuit: Pursuit) -> list:
    outcomes = []
    while pursuit.busy:
        outcomes.append(pursuit.step())
    return outcomes


@pytest.mark.parametrize(
    "seconds, megabytes, kept, raw",
    [
        (10.0, 10.0, 40, 40),
        (0.5, 10.0, 16, 16),
        (0.0, 10.0, 1, 1),
        (10.0, 1.0, 40, 13),  # the oldest as JPEG
        (10.0, 0.1, 11, 1),  # and then none
        (10.0, 0.0, 1, 1),
    ],
)
def test_ring_is_bounded_in_time_and_memory(made_footage, seconds, megabytes, kept, raw):
    frames, _ = made_footage
    ring = FrameRing(seconds, megabytes)
    for number, pixels in enumerate(frames):
        ring.add(frame_of(pixels, number))
        assert ring.size <= max(megabytes * 1e6, ring.newest.size)
        assert ring.size == sum(f.size for f in ring._frames)
    still_raw = [f for f in ring._frames if f.message.__class__.__name__ == "Image"]
    assert len(still_raw) == pytest.approx(raw, abs=2)
    assert len(ring) == pytest.approx(kept, abs=4 if raw < kept else 0)
    assert ring.newest.stamp == frame_of(frames[0], 39).stamp


def test_what_the_ring_keeps_as_jpeg_is_still_the_image(made_footage):
    frames, _ = made_footage
    ring = FrameRing(10, 0.5)
    for number, pixels in enumerate(frames):
        ring.add(frame_of(pixels, number))
    oldest = ring.nearest(0)
    assert oldest.message.__class__.__name__ == "CompressedImage"
    number = (oldest.stamp - SECOND) // STEP
    difference = np.abs(array_of(oldest.message).astype(int) - frames[number])
    assert difference.mean() < 3


def test_nearest_and_since(made_footage):
    ring = FrameRing(10, 10)
    assert ring.nearest(5) is None
    assert ring.newest is None
    for number, pixels in enumerate(made_footage[0][:10]):
        ring.add(frame_of(pixels, number))
    found = ring.nearest(SECOND + 4 * STEP + 1000)
    assert found.stamp == SECOND + 4 * STEP
    assert [f.stamp for f in ring.since(found)] == [SECOND + i * STEP for i in range(5, 10)]
    ring.remove(found)
    assert ring.nearest(SECOND + 4 * STEP).stamp != found.stamp
    ring.clear()
    assert (len(ring), ring.size) == (0, 0)


def test_a_late_box_ends_where_one_in_time_ends(made_footage):
    frames, box = made_footage
    in_time, late = pursuit_of(), pursuit_of()
    for number, pixels in enumerate(frames[:16]):
        for pursuit in (in_time, late):
            pursuit.on_frame(frame_of(pixels, number))
            outcomes = run(pursuit)
        if number == 0:
            in_time.on_box(Box(*box), SECOND)
    wanted = outcomes  # of `late`, idle up to here
    assert wanted[-1].estimate is None

    first = late.on_box(Box(*box), SECOND)
    caught_up = run(late)
    assert not first.published  # newer frames were answered already
    assert [o.published for o in caught_up] == [False] * 14 + [True]
    in_time.on_frame(frame_of(frames[16], 16))
    late.on_frame(frame_of(frames[16], 16))
    assert run(in_time)[-1].estimate.box == run(late)[-1].estimate.box


@pytest.mark.parametrize(
    "settings, age, says",
    [
        (
            {"ring_seconds": 0.3},
            0.9,
            "0.90 s older than the newest, and images are kept for 0.30 s",
        ),
        ({"ring_seconds": 0.0}, 0.5, "kept for 0.00 s"),
        ({}, 100.0, "100 s before the newest image's, which is another clock"),
    ],
)
def test_a_box_too_old_is_refused_with_both_ages(made_footage, settings, age, says):
    frames, box = made_footage
    pursuit = pursuit_of(**settings)
    for number, pixels in enumerate(frames):
        frame = frame_of(pixels, number)
        pursuit.on_frame(Frame(frame.message, frame.stamp + 200 * SECOND, 0.0))
        run(pursuit)
    newest = SECOND + 39 * STEP + 200 * SECOND
    with pytest.raises(BoxError, match=says):
        pursuit.on_box(Box(*box), newest - round(age * SECOND))


def test_a_box_for_an_image_that_never_came_is_refused(made_footage):
    frames, box = made_footage
    pursuit = pursuit_of(box_tolerance=0.05)
    for number in (0, 10, 11):
        pursuit.on_frame(frame_of(frames[number], number))
    with pytest.raises(BoxError, match=r"no image came within 0\.05 s"):
        pursuit.on_box(Box(*box), SECOND + 5 * STEP)
    assert pursuit.on_box(Box(*box), SECOND + 1 * STEP).frame.stamp == SECOND


def test_a_refused_late_box_leaves_the_track_as_it_was(made_footage):
    frames, box = made_footage
    left, right = pursuit_of(), pursuit_of()
    for number, pixels in enumerate(frames[:12]):
        for pursuit in (left, right):
            pursuit.on_frame(frame_of(pixels, number))
            outcomes = run(pursuit)
            if number == 0:
                pursuit.on_box(Box(*box), 0)
        if number == 9:
            with pytest.raises(BoxError, match="outside"):
                left.on_box(Box(500, 500, 20, 20), SECOND + 2 * STEP)
            assert not left.busy
    assert left.session.state == right.session.state
    left.on_frame(frame_of(frames[12], 12))
    right.on_frame(frame_of(frames[12], 12))
    assert run(left)[-1].estimate.box == run(right)[-1].estimate.box
    assert outcomes


def test_a_bag_in_a_loop_starts_again_with_its_box_whatever_comes_first(made_footage):
    frames, box = made_footage
    pursuit = pursuit_of(ring_seconds=0.5)
    for box_first in (True, False, True):
        if box_first:
            try:
                pursuit.on_box(Box(*box), SECOND)
            except BoxError as error:
                assert "older than the newest" in str(error)
        for number, pixels in enumerate(frames):
            pursuit.on_frame(frame_of(pixels, number))
            outcome = run(pursuit)[-1]
            if number == 0 and not box_first:
                outcome = pursuit.on_box(Box(*box), SECOND)
            assert outcome.estimate is not None
    assert pursuit.track == 3


def test_in_a_hurry_frames_are_left_out_but_never_the_newest(made_footage, monkeypatch):
    frames, box = made_footage
    pursuit = pursuit_of(ring_seconds=10.0)
    for number, pixels in enumerate(frames):
        pursuit.on_frame(frame_of(pixels, number))
        run(pursuit)
    clock = iter(np.arange(0, 1000, 0.05))  # every step takes 50 ms, a frame time and a half
    monkeypatch.setattr("het_ros.ros.pursuit.time.monotonic", lambda: next(clock))
    pursuit.on_box(Box(*box), SECOND)
    outcomes = []
    while pursuit.busy:
        outcomes.append(pursuit.step(hurry=True))
    assert pursuit.counts["skipped"] > 20
    assert len(outcomes) + pursuit.counts["skipped"] == 39
    assert outcomes[-1].frame.stamp == SECOND + 39 * STEP


def test_images_that_come_while_catching_up_are_not_lost(graph, made_footage):
    frames, box = made_footage
    sent = []
    node = TrackerNode(context=graph.context, tap=lambda topic, m: sent.append((topic, m)))
    graph.add(node)
    for number in range(20):
        node.on_image(image_message(frames[number], header_at(1 + number * FRAME_TIME)))
    del sent[:]
    node.on_init_box(box_message(box, header_at(1.0)))
    for number in range(20, 25):
        node.on_image(image_message(frames[number], header_at(1 + number * FRAME_TIME)))
    last = header_at(1 + 24 * FRAME_TIME)
    graph.spin_until(lambda: sent and dict(sent)["status"].header == last, "catching up")
    stamps = [m.header.stamp.nanosec for topic, m in sent if topic == "box"]
    assert stamps == sorted(stamps)
    assert (
        box_from_polygon([m for topic, m in sent if topic == "box"][-1]).iou(
            Box(20 + 48, 40 + 12, 20, 32)
        )
        > 0.6
    )


def test_a_box_half_a_second_late_on_real_footage(graph, sequences):
    """Human7 at 30 frames/s: half a second after it came, the late box is where it should be."""
    human = read_sequences(sequences, ("Human7",), {})[0]
    start = tuple(human.truth[0])
    images = [image for image, _ in zip(human.frames, range(31), strict=False)]
    in_time, late = ByHand(graph, name="in_time"), ByHand(graph, name="late")
    for number, pixels in enumerate(images):
        outputs = {h: h.image(pixels, 1 + number * FRAME_TIME) for h in (in_time, late)}
        if number == 0:
            in_time.box(start, 1.0)
        if number == 15:
            late.box(start, 1.0)
    boxes = [box_from_polygon(outputs[hand]["box"]) for hand in (in_time, late)]
    assert boxes[0] == boxes[1]
