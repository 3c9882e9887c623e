# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Outputs that need more than an image: bearing, place, detections, debug image, diagnostics."""

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, Image

from het_ros import Box, Estimate, State
from het_ros.ros import answers, tracker_node
from het_ros.ros.debug_image import drawn
from het_ros.ros.detections import detections_message
from het_ros.ros.images import to_array
from het_ros.ros.messages import box_from_polygon
from het_ros.ros.status import status_values
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tracking.estimate import Patch

from .streams import FRAME_TIME, ByHand, Camera, header_at, image_message
from .vision import VISION

MATRIX = [200.0, 0.0, 80.0, 0.0, 200.0, 60.0, 0.0, 0.0, 1.0]


def depth_message(metres: float, seconds: float, frame_id: str = "camera") -> Image:
    pixels = np.full((120, 160), metres, np.float32)
    return Image(
        header=header_at(seconds, frame_id), width=160, height=120, encoding="32FC1",
        step=640, data=pixels.tobytes(),
    )  # fmt: skip


@pytest.fixture
def hand(graph, made_footage):
    """A node by hand that follows the made target, with a camera_info."""
    frames, box = made_footage
    hand = ByHand(graph)
    hand.node.space.on_camera_info(CameraInfo(width=160, height=120, k=MATRIX))
    hand.image(frames[0], 1.0)
    hand.box(box)
    return hand


def test_bearing_points_through_the_box(hand, made_footage):
    outputs = hand.image(made_footage[0][1], 1 + FRAME_TIME)
    x, y = box_from_polygon(outputs["box"]).centre
    ray = outputs["bearing"].vector
    assert outputs["bearing"].header == outputs["box"].header
    assert np.linalg.norm([ray.x, ray.y, ray.z]) == pytest.approx(1)
    assert 200 * ray.x / ray.z + 80.5 == pytest.approx(x, abs=1e-3)
    assert 200 * ray.y / ray.z + 60.5 == pytest.approx(y, abs=1e-3)
    assert "target_pose" not in outputs  # no depth came


def test_target_pose_lies_at_the_depth(hand, made_footage):
    hand.node.space.on_depth(depth_message(3.0, 1 + FRAME_TIME))
    outputs = hand.image(made_footage[0][1], 1 + FRAME_TIME)
    place, ray = outputs["target_pose"].pose.position, outputs["bearing"].vector
    assert outputs["target_pose"].header == outputs["box"].header
    assert place.z == pytest.approx(3.0)
    assert place.x == pytest.approx(3.0 * ray.x / ray.z)


@pytest.mark.parametrize(
    "depth",
    [
        depth_message(float("nan"), 1 + FRAME_TIME),
        depth_message(0.0, 1 + FRAME_TIME),
        depth_message(3.0, 0.9),  # of another time
        Image(header=header_at(1 + FRAME_TIME), width=1, height=1, encoding="rgb8", step=3),
    ],
)
def test_no_target_pose_without_depth_of_the_target(hand, made_footage, depth):
    hand.node.space.on_depth(depth)
    outputs = hand.image(made_footage[0][1], 1 + FRAME_TIME)
    assert "target_pose" not in outputs
    assert "bearing" in outputs


@pytest.mark.parametrize("witness", [True, False])
def test_a_box_that_holds_another_thing_by_its_depth(hand, made_footage, witness):
    """The images alone would follow on; with depth the target is hidden until it is back."""
    hand.node.set_parameters([Parameter("depth_witness", value=witness)])
    for i in range(1, 18):
        denied = 5 <= i < 10
        hand.node.space.on_depth(depth_message(1.2 if denied else 3.0, 1 + i * FRAME_TIME))
        outputs = hand.image(made_footage[0][i], 1 + i * FRAME_TIME)
        if i < 10:
            state = "COASTING" if witness and denied else "TRACKING"
            assert hand.state_of(outputs) == state
            assert ("target_pose" in outputs) == (not denied)
    assert "target_pose" in outputs


def test_no_bearing_without_calibration(graph, made_footage):
    frames, box = made_footage
    hand = ByHand(graph)
    hand.image(frames[0], 1.0)
    assert "bearing" not in hand.box(box)
    hand.node.space.on_camera_info(CameraInfo(width=640, height=480, k=MATRIX))
    assert "bearing" not in hand.image(frames[1], 1 + FRAME_TIME)


@pytest.mark.parametrize("vision", [VISION, tracker_node.vision_msgs], ids=["stand-in", "real"])
def test_detections_as_vision_msgs_has_them(vision):
    if vision is None:
        pytest.skip("vision_msgs is not on PyPI: apt's ROS has it")
    estimate = Estimate(Box(10, 20, 30, 40), (0.0, 0.0), np.eye(4), 0.75, State.TRACKING)
    message = detections_message(estimate, 3, header_at(1.0), vision)
    (detection,) = message.detections
    assert message.header == detection.header == header_at(1.0)
    assert (detection.bbox.center.position.x, detection.bbox.center.position.y) == (25, 40)
    assert (detection.bbox.size_x, detection.bbox.size_y) == (30, 40)
    assert detection.id == "3"
    assert detection.results[0].hypothesis.score == 0.75
    assert detection.results[0].hypothesis.class_id == "target"


def test_the_id_is_the_tracks(hand, made_footage, monkeypatch):
    ids = []
    monkeypatch.setattr(
        answers, "detections_message", lambda estimate, track, header: ids.append(track)
    )
    hand.node._outputs._publishers["detections"] = hand.node._outputs._publishers["box"]
    for i in (1, 2):
        hand.image(made_footage[0][i], 1 + i * FRAME_TIME)
    hand.box((26, 41, 20, 32))
    hand.image(made_footage[0][3], 1 + 3 * FRAME_TIME)
    assert ids == [1, 1, 2, 2]
    del hand.node._outputs._publishers["detections"]


def test_vision_msgs_are_not_needed(hand):
    if tracker_node.vision_msgs is not None:
        pytest.skip("vision_msgs is installed here")
    assert "detections" not in hand.node._outputs
    assert "tracker/detections" not in dict(hand.node.get_topic_names_and_types())


@pytest.mark.parametrize("shape", [(120, 160), (120, 160, 3)])
@pytest.mark.parametrize("state", list(State))
def test_debug_image_shows_the_estimate(shape, state):
    patches = (Patch(Box(30, 30, 10, 10), 0.0), Patch(Box(50, 50, 10, 10), 1.0))
    estimate = Estimate(Box(25, 25, 60, 60), (1e6, -1e6), np.eye(4), 0.5, state, patches)
    pixels = np.full(shape, 90, np.uint8)
    image = drawn(pixels, estimate if state is not State.IDLE else None, state, "why")
    assert image.shape == (120, 160, 3)
    assert (pixels == 90).all()  # the tracker's own image is left alone
    assert (image[:20] != 90).any()  # the words
    edge = image[50, 23:27]
    assert (edge != 90).any() == (state in (State.TRACKING, State.COASTING))


def test_debug_image_is_drawn_for_subscribers_only_and_not_too_often(
    graph, made_footage, monkeypatch
):
    frames, _ = made_footage
    drawings = []

    def counted(*arguments):
        drawings.append(arguments)
        return drawn(*arguments)

    monkeypatch.setattr(answers, "drawn", counted)
    node = graph.add(TrackerNode(context=graph.context))
    for i in range(5):
        node.on_image(image_message(frames[i], header_at(1 + i * FRAME_TIME)))
    assert not drawings

    got = []
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(Image, "tracker/debug_image", got.append, 50)
    graph.spin_until(lambda: node._outputs.heard("debug_image"), "discovery")
    for i in range(5, 35):
        node.on_image(image_message(frames[i], header_at(1 + i * FRAME_TIME)))
    graph.spin_until(lambda: len(got) == len(drawings), "the images")
    assert 9 <= len(drawings) <= 11  # a second at debug_rate
    assert to_array(got[0]).shape == (120, 160, 3)
    assert got[0].header == header_at(1 + 5 * FRAME_TIME)


def test_diagnostics_once_a_second(graph, made_footage):
    frames, _ = made_footage
    node = graph.add(TrackerNode(context=graph.context))
    got = []
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(DiagnosticArray, "/diagnostics", got.append, 10)
    for i in (0, 1, 2, 2, 1):
        node.on_image(image_message(frames[i], header_at(1 + i * FRAME_TIME)))
    bad = image_message(frames[3], header_at(1 + 3 * FRAME_TIME))
    bad.encoding = "vapour"
    node.on_image(bad)
    graph.spin_until(lambda: len(got) >= 2, "two reports")
    values = status_values(got[0])
    assert got[0].status[0].name == "tracker: tracking"
    counts = {k: int(values[k]) for k in ("processed", "duplicate", "late", "unreadable")}
    assert counts == {"processed": 3, "duplicate": 1, "late": 1, "unreadable": 1}
    assert 0 < float(values["latency_p50_ms"]) <= float(values["latency_p99_ms"])
    assert got[0].status[0].level == DiagnosticStatus.OK
    assert got[1].status[0].level == DiagnosticStatus.WARN  # images stopped
    assert got[1].status[0].message == "no images"


@pytest.fixture
def warnings(monkeypatch):
    from rclpy.impl.rcutils_logger import RcutilsLogger

    heard = []
    monkeypatch.setattr(RcutilsLogger, "warning", lambda _, text, **__: heard.append(text))
    return heard


def test_a_publisher_that_offers_less_is_explained(graph, warnings):
    reliability = Parameter("qos_overrides./image.subscription.reliability", value="reliable")
    graph.add(TrackerNode(context=graph.context, parameter_overrides=[reliability]))
    graph.add(Camera(context=graph.context))  # offers best effort
    graph.spin_until(lambda: any("reliability" in text for text in warnings), "the explanation")
    (text,) = [text for text in warnings if "reliability" in text]
    assert "-p qos_overrides./image.subscription.reliability:=" in text


def test_an_override_holds_for_its_topic_alone(graph):
    reliability = Parameter("qos_overrides./image.subscription.reliability", value="reliable")
    node = graph.add(TrackerNode(context=graph.context, parameter_overrides=[reliability]))
    asked = {s.topic_name: s.qos_profile.reliability.name for s in node.subscriptions}
    assert asked["/image"] == "RELIABLE"
    assert asked["/depth"] == asked["/camera_info"] == "BEST_EFFORT"


def test_a_subscriber_that_asks_for_more_is_explained(graph, warnings):
    node = graph.add(TrackerNode(context=graph.context))
    viewer = graph.add(Node("viewer", context=graph.context))
    latched = QoSProfile(
        depth=1,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        reliability=ReliabilityPolicy.RELIABLE,
    )
    viewer.create_subscription(Image, "tracker/debug_image", print, latched)
    graph.spin_until(lambda: any("durability" in text for text in warnings), "the explanation")
    parameter = "qos_overrides./tracker/debug_image.publisher.durability"
    assert any(f"-p {parameter}:=" in text for text in warnings)
    assert node.has_parameter(parameter)


def test_an_output_can_be_latched(graph):
    durability = Parameter(
        "qos_overrides./tracker/status.publisher.durability", value="transient_local"
    )
    node = graph.add(TrackerNode(context=graph.context, parameter_overrides=[durability]))
    offered = {p.topic_name: p.qos_profile.durability.name for p in node.publishers}
    assert offered["/tracker/status"] == "TRANSIENT_LOCAL"
    assert offered["/tracker/box"] == "VOLATILE"


def test_every_topic_has_qos_parameters(graph):
    node = graph.add(TrackerNode(context=graph.context))
    names = list(node.get_parameters_by_prefix("qos_overrides"))
    for topic in ("/image", "/depth", "/camera_info", "/tracker/init_box", "/tracker/init_roi"):
        assert f"{topic}.subscription.reliability" in names
    for topic in (*(f"/tracker/{name}" for name in tracker_node.OUTPUTS), "/diagnostics"):
        assert f"{topic}.publisher.depth" in names


def test_motion_in_the_scene_and_in_metres(hand, made_footage):
    hand.node.space.on_depth(depth_message(3.0, 1 + FRAME_TIME))
    outputs = hand.image(made_footage[0][1], 1 + FRAME_TIME)
    for topic in ("velocity_in_scene", "target_velocity", "target_pose_cov"):
        assert outputs[topic].header == outputs["box"].header
    assert outputs["target_pose_cov"].pose.pose.position.z == pytest.approx(3.0)


def test_latency_ahead_moves_places_and_no_velocity(graph, made_footage):
    """Two nodes on the same images; one publishes what will be half a second later."""
    frames, box = made_footage
    ahead = 0.5
    hands = [
        ByHand(graph, parameter_overrides=[Parameter("latency_ahead", value=seconds)])
        for seconds in (0.0, ahead)
    ]
    for hand in hands:
        hand.node.space.on_camera_info(CameraInfo(width=160, height=120, k=MATRIX))
        hand.image(frames[0], 1.0)
        hand.box(box)
    for i in range(1, 12):
        time = 1 + i * FRAME_TIME
        for hand in hands:
            hand.node.space.on_depth(depth_message(3.0, time))
        now, later = (hand.image(frames[i], time) for hand in hands)

    speed = now["velocity"].twist.twist.linear
    assert np.hypot(speed.x, speed.y) > 10  # px/s: there is a way to go
    for topic in ("velocity", "velocity_in_scene", "target_velocity"):
        assert later[topic] == now[topic]
    way = np.subtract(*(box_from_polygon(each["box"]).centre for each in (later, now)))
    centre = later["pose"].pose.pose.position
    assert (centre.x, centre.y) == pytest.approx(box_from_polygon(later["box"]).centre, abs=1e-3)
    assert np.dot(way, [speed.x, speed.y]) > 0
    assert later["bearing"] != now["bearing"]
    metres = now["target_velocity"].twist.twist.linear
    for topic in ("target_pose", "target_pose_cov"):
        assert later[topic].header == now[topic].header == now["box"].header
        here, there = (each[topic].pose for each in (now, later))
        here, there = (getattr(pose, "pose", pose).position for pose in (here, there))
        moved = np.array([there.x - here.x, there.y - here.y])
        assert np.dot(moved, [metres.x, metres.y]) > 0
    assert later["pose"].pose.covariance[0] > now["pose"].pose.covariance[0]
