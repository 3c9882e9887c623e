# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Images wait for the depth that belongs to them, and for no other."""

import random
import time

import numpy as np
import pytest
from geometry_msgs.msg import PolygonStamped, PoseStamped
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import CameraInfo, Image

from het_ros.ros.depth_wait import VAIN, DepthWait
from het_ros.ros.status import status_values
from het_ros.ros.tracker_node import TrackerNode

from .streams import box_message, header_at, image_message

NS = 1_000_000_000


class Clock:
    """A monotonic clock that is set by hand."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


def waits(rate, depth_rate, lag, frames=60, limit=0.1, shift=0.0, seed=0):
    """How long each image of a stream waits, s, and whether its depth was there then.

    ``lag`` is (least, most) s from image to depth of one stamp; ``shift`` s between the stamps.
    """
    clock, drawn = Clock(), random.Random(seed)
    wait = DepthWait(limit, clock)
    images = [(i / rate, i / rate) for i in range(frames)]
    depths = [
        (i / depth_rate + drawn.uniform(*lag), i / depth_rate + shift)
        for i in range(int(frames * depth_rate / rate))
    ]
    here, waited, met = [], [], []
    for stamp, due in images:
        end = due
        while True:
            came = sorted(d for d in depths if d[0] <= end and d[1] not in here)
            for arrival, depth in came:
                clock.now = 100.0 + max(arrival, due)
                here.append(depth)
                wait.depth(round((10 + depth) * NS))
            clock.now = 100.0 + end
            left = wait.left(round((10 + stamp) * NS), 100.0 + due)
            if left <= 0:
                break
            later = [d[0] for d in depths if d[1] not in here]
            end = min([end + left, *(a for a in later if a > end)])
        waited.append(end - due)
        met.append(any(abs(depth - stamp) < 0.002 for depth in here))
    return np.array(waited), np.array(met)


@pytest.mark.parametrize("rate", [5, 15, 30])
@pytest.mark.parametrize(
    "lag", [(-0.02, -0.02), (0.0, 0.0), (0.02, 0.02), (0.06, 0.06), (-0.03, 0.06)]
)
def test_an_image_waits_for_its_depth_and_no_longer(rate, lag):
    waited, met = waits(rate, rate, lag)
    # Where depth images change places, that is learnt by the first that does.
    assert met[3:].mean() >= (0.95 if lag[0] < lag[1] else 1)
    assert waited.max() <= max(lag[1], 0) + 1e-6


def test_depth_that_comes_too_late_is_not_waited_for_for_ever():
    waited, _ = waits(30, 30, (0.25, 0.25))
    assert np.count_nonzero(waited > 0) == VAIN


def test_depth_at_half_the_rate_delays_no_image_that_has_none():
    """Every second image has no depth of its own; the next one is as near as the last."""
    waited, met = waits(30, 15, (0.02, 0.02), frames=120)
    assert met[4::2].all()
    assert waited[6:].max() < 0.03


def test_depth_of_another_exposure_is_waited_for_where_it_is_the_nearer():
    waited, _ = waits(30, 30, (0.01, 0.01), shift=0.005)
    assert 0 < waited[5:].max() < 0.02
    waited, _ = waits(30, 30, (0.01, 0.01), shift=0.020)
    assert waited[5:].max() == 0  # the one before the image is the nearer


@pytest.mark.parametrize("off", [3600.0, -3600.0])
def test_depth_of_another_clock_is_not_waited_for(off):
    waited, _ = waits(30, 30, (0.0, 0.0), shift=off)
    assert waited.max() == 0


def test_nobody_waits_where_depth_is_over_or_was_never():
    clock = Clock()
    wait = DepthWait(0.1, clock)
    assert wait.left(10 * NS, clock.now) == 0
    for i in range(10):
        wait.depth(10 * NS + i * NS // 30)
    assert wait.left(10 * NS + 10 * NS // 30, clock.now) > 0
    clock.now += 2.0
    assert wait.left(12 * NS, clock.now) == 0


def test_nobody_waits_without_a_limit():
    waited, _ = waits(30, 30, (0.02, 0.02), limit=0.0)
    assert waited.max() == 0


def test_it_waits_again_once_depth_comes_in_time():
    clock = Clock()
    wait = DepthWait(0.1, clock)

    def frame(i, lag):
        stamp, arrival = 10 * NS + i * NS // 10, 100.0 + i / 10
        clock.now = arrival
        waited = wait.left(stamp, arrival) > 0
        if waited and lag > 0.1:
            clock.now = arrival + 0.1
            assert wait.left(stamp, arrival) == 0
        clock.now = arrival + lag
        wait.depth(stamp)
        return waited

    early = [frame(i, 0.15) for i in range(20)]
    assert wait.in_vain and not early[-1]
    late = [frame(i, 0.02) for i in range(20, 25)]
    assert late[-1] and not wait.in_vain


def depth_message(header):
    pixels = np.full((120, 160), 3.0, np.float32)
    return Image(
        header=header, width=160, height=120, encoding="32FC1", step=640, data=pixels.tobytes()
    )


class DepthCamera(Node):
    """Sends images and depth when they are due, and keeps states and places by stamp."""

    def __init__(self, **options):
        super().__init__("camera", **options)
        self.images = self.create_publisher(Image, "image", 10)
        self.depths = self.create_publisher(Image, "depth", 10)
        self.infos = self.create_publisher(CameraInfo, "camera_info", 10)
        self.boxes = self.create_publisher(PolygonStamped, "tracker/init_box", 10)
        self.places: list[PoseStamped] = []
        self.create_subscription(PoseStamped, "tracker/target_pose", self.places.append, 100)

    def connected(self):
        publishers = (self.images, self.depths, self.infos)
        return self.count_publishers("tracker/target_pose") > 0 and all(
            p.get_subscription_count() for p in publishers
        )

    def play(self, graph, node, frames, rate, lag):
        """Images at ``rate``, depth drawn from ``lag`` (least, most) s after them.

        However busy the machine is, each is sent after the one before has come to the node.
        """
        drawn = random.Random(1)
        events = []
        for i, pixels in enumerate(frames):
            header = header_at(1 + i / rate)
            events.append((i / rate, i, self.images, image_message(pixels, header)))
            due = i / rate + drawn.uniform(*lag)
            events.append((due, i, self.depths, depth_message(header)))
        came = []
        node.images.join(lambda frame: came.append(1))
        on_depth = node.space.on_depth
        node.space.on_depth = lambda message: (on_depth(message), came.append(1))
        start = time.monotonic() + 0.1
        for sent, (due, _, publisher, message) in enumerate(
            sorted(events, key=lambda e: e[:2]), 1
        ):
            while time.monotonic() < start + due:
                graph.executor.spin_once(timeout_sec=max(start + due - time.monotonic(), 0))
            publisher.publish(message)
            graph.spin_until(lambda sent=sent: len(came) >= sent, "a message")


@pytest.mark.parametrize(
    "rate, lag, limit",
    [
        (15, (0.02, 0.02), 0.1),
        (30, (-0.03, 0.06), 0.1),
        (5, (0.06, 0.06), 0.1),
        (15, (0.02, 0.02), 0.0),  # nothing waits, and the place follows
        (30, (0.15, 0.15), 0.1),  # too late to be waited for
    ],
)
def test_nearly_every_tracking_frame_has_its_place(graph, made_footage, rate, lag, limit):
    frames, box = made_footage
    sent = []
    node = graph.add(
        TrackerNode(
            context=graph.context,
            tap=lambda *output: sent.append(output),
            parameter_overrides=[Parameter("depth_wait", value=limit)],
        )
    )
    camera = graph.add(DepthCamera(context=graph.context))
    graph.spin_until(camera.connected, "discovery")
    camera.infos.publish(
        CameraInfo(width=160, height=120, k=[200.0, 0.0, 80.0, 0.0, 200.0, 60.0, 0.0, 0.0, 1.0])
    )
    graph.spin_until(lambda: "camera_info" in node.space.came, "the calibration")
    node.on_image(image_message(frames[0], header_at(0.9)))
    node.on_init_box(box_message(box))
    camera.play(graph, node, frames, rate, lag)
    last = header_at(1 + (len(frames) - 1) / rate)
    graph.spin_until(lambda: camera.places and camera.places[-1].header == last, "the last place")

    statuses = [m for topic, m in sent if topic == "status"]
    tracking = [m.header for m in statuses if status_values(m)["state"] == "TRACKING"][1:]
    placed = [place.header for place in camera.places]
    assert len(tracking) > 10
    assert sum(header in placed for header in tracking) >= 0.95 * len(tracking)
    stamps = [header.stamp.sec + 1e-9 * header.stamp.nanosec for header in placed]
    assert stamps == sorted(stamps)


def test_late_places_are_filtered_too(graph, made_footage):
    """Depth that comes after its image was answered gives all that is known in metres."""
    frames, box = made_footage
    sent = []
    node = graph.keep(TrackerNode(context=graph.context, tap=lambda *output: sent.append(output)))
    node.space.on_camera_info(
        CameraInfo(width=160, height=120, k=[200.0, 0.0, 80.0, 0.0, 200.0, 60.0, 0.0, 0.0, 1.0])
    )
    node.on_image(image_message(frames[0], header_at(1.0)))
    node.on_init_box(box_message(box))
    node.on_image(image_message(frames[1], header_at(1.1)))
    topics = ("target_pose", "target_pose_cov", "target_velocity")
    assert not {topic for topic, _ in sent} & set(topics)
    for stamp in (1.0, 1.1):
        node._on_depth(depth_message(header_at(stamp)), {})
    for topic in topics:
        stamps = [message.header for name, message in sent if name == topic]
        assert stamps == [header_at(1.0), header_at(1.1)]


def test_the_witness_waits_too(graph, made_footage):
    """What comes before the target 20 ms after its image was taken is known when it is judged."""
    frames, box = made_footage
    asked = []
    node = graph.add(TrackerNode(context=graph.context))
    camera = graph.add(DepthCamera(context=graph.context))
    graph.spin_until(camera.connected, "discovery")
    real = node.space.may_hold

    def may_hold(box, size, header, track):
        asked.append(node.space.seen(header))
        return real(box, size, header, track)

    node._pursuit._witness = may_hold
    node.on_image(image_message(frames[0], header_at(0.9)))
    node.on_init_box(box_message(box))
    camera.play(graph, node, frames[:20], 15, (0.02, 0.02))
    graph.settle()
    assert len(asked) > 5
    assert np.mean(asked[2:]) > 0.8  # on a busy machine one may not be waited for
