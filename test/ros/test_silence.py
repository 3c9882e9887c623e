# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the node says while no new image comes, or an input that somebody waits for."""

import time
from collections import Counter

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped, Vector3Stamped
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import Float32
from std_srvs.srv import SetBool, Trigger

from het_ros import State
from het_ros.ros import input_hints
from het_ros.ros.messages import stamp_ns
from het_ros.ros.silence import waiting_on
from het_ros.ros.status import LEVELS, level_of, status_values
from het_ros.ros.tracker_node import TrackerNode
from het_ros.ros.watch import Watch

from .streams import FRAME_TIME, box_message, header_at, image_message
from .test_depth_wait import Clock

TIMEOUT = 0.3  # s


@pytest.fixture
def log(monkeypatch):
    """What is logged, each line with its level."""
    lines = []
    for level in ("info", "warning", "error", "fatal"):

        def keep(_, text, level=level, **__):
            lines.append((level, text))

        monkeypatch.setattr(RcutilsLogger, level, keep)
    return lines


@pytest.fixture
def sent():
    return []


@pytest.fixture
def node(graph, sent):
    """A node that is spun, whose outputs are kept."""
    return graph.add(
        TrackerNode(
            context=graph.context,
            tap=lambda topic, message: sent.append((topic, message)),
            parameter_overrides=[Parameter("image_timeout", value=TIMEOUT)],
        )
    )


def follow(node, made_footage, count=3):
    frames, box = made_footage
    node.on_image(image_message(frames[0], header_at(1.0)))
    node.on_init_box(box_message(box))
    for i in range(1, count):
        node.on_image(image_message(frames[i], header_at(1 + i * FRAME_TIME)))
    assert node.state is State.TRACKING


def statuses(sent):
    return [message for topic, message in sent if topic == "status"]


def warnings(log):
    return [text for level, text in log if level == "warning"]


# The camera dies -----------------------------------------------------------------------------


def test_a_camera_that_dies_is_told_of_once_in_the_log_and_every_second_in_the_status(
    graph, node, sent, log, made_footage
):
    follow(node, made_footage)
    del sent[:]
    begun = time.monotonic()
    graph.spin_until(lambda: len(statuses(sent)) >= 3, "three statuses without an image")
    assert time.monotonic() - begun > TIMEOUT + 2 * 0.9  # the first, and one a second
    assert {topic for topic, _ in sent} == {"status", "score"}
    for message in statuses(sent):
        values = status_values(message)
        assert values["state"] == "LOST"
        assert "no image for" in values["reason"]
        assert message.status[0].level == DiagnosticStatus.ERROR
    assert next(m.data for topic, m in sent if topic == "score") == 0
    stamps = [stamp_ns(message.header) for message in statuses(sent)]
    assert stamps == sorted(set(stamps))
    assert stamps[0] > round((1 + 2 * FRAME_TIME) * 1e9)  # the camera's clock, carried on
    assert node.state is State.LOST
    told = [text for text in warnings(log) if "no image for" in text]
    assert len(told) == 1 and "waiting on /image" in told[0]


def test_a_track_goes_on_when_images_come_again_in_time(graph, node, sent, log, made_footage):
    follow(node, made_footage)
    graph.spin_until(lambda: node.state is State.LOST, "the silence")
    node.on_image(image_message(made_footage[0][3], header_at(1 + 3 * FRAME_TIME)))
    assert node.state is State.TRACKING
    assert status_values(statuses(sent)[-1])["state"] == "TRACKING"
    assert any("images come again, after" in text for level, text in log if level == "info")


def test_without_a_track_it_is_idle_that_is_told(graph, node, sent):
    graph.spin_until(lambda: statuses(sent), "a status")
    message = statuses(sent)[0]
    assert status_values(message)["state"] == "IDLE"
    assert "no image for" in status_values(message)["reason"]
    assert message.status[0].level == DiagnosticStatus.WARN


def test_the_debug_image_says_so_too(graph, node, made_footage):
    """Who looks at pictures only sees no green box that stands still."""
    got = []
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(Image, "tracker/debug_image", got.append, 10)
    graph.spin_until(lambda: node._outputs.heard("debug_image"), "discovery")
    follow(node, made_footage)
    graph.spin_until(lambda: got, "a picture")
    shown = len(got)
    graph.spin_until(lambda: node.state is State.LOST and len(got) > shown, "another picture")
    assert stamp_ns(got[-1].header) > stamp_ns(got[shown - 1].header)
    assert bytes(got[-1].data) != bytes(got[shown - 1].data)


def test_diagnostics_say_the_same(graph, node, made_footage):
    got = []
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(DiagnosticArray, "/diagnostics", got.append, 10)
    graph.spin_until(lambda: got, "diagnostics")
    follow(node, made_footage)
    graph.spin_until(lambda: "LOST: no image for" in got[-1].status[0].message, "the reason")
    status = got[-1].status[0]
    assert status.level == DiagnosticStatus.ERROR
    assert status.hardware_id == "camera"  # the frame of its images, no node


def test_the_timeout_may_be_set_later(graph, made_footage, sent):
    node = graph.add(TrackerNode(context=graph.context, tap=lambda *output: sent.append(output)))
    follow(node, made_footage)
    node.set_parameters([Parameter("image_timeout", value=TIMEOUT)])
    graph.spin_until(lambda: node.state is State.LOST, "the silence")
    node.set_parameters([Parameter("image_timeout", value=0.0)])
    node.on_image(image_message(made_footage[0][3], header_at(1 + 3 * FRAME_TIME)))
    end = time.monotonic() + 3 * TIMEOUT
    graph.spins_until(lambda: time.monotonic() > end, 3)
    assert node.state is State.TRACKING


def test_a_disabled_node_misses_no_image(graph, node, log, made_footage):
    follow(node, made_footage)
    node._on_enable(SetBool.Request(data=False), SetBool.Response())
    end = time.monotonic() + 3 * TIMEOUT
    graph.spins_until(lambda: time.monotonic() > end, 3)
    assert not [text for text in warnings(log) if "no image" in text]
    node._on_enable(SetBool.Request(data=True), SetBool.Response())
    graph.settle(1)
    assert node.state is State.TRACKING


# Stamps that stand still ---------------------------------------------------------------------


def test_frozen_stamps_are_told_with_the_reason(graph, node, sent, log, made_footage):
    follow(node, made_footage)
    same = image_message(made_footage[0][3], header_at(1 + 2 * FRAME_TIME))

    def told() -> bool:
        node.on_image(same)
        return any("no new image" in text for text in warnings(log))

    graph.spin_until(told, "the warning")
    (text,) = [text for text in warnings(log) if "no new image" in text]
    assert "with the stamp of the one before" in text
    values = status_values(statuses(sent)[-1])
    assert values["state"] == "LOST" and "the stamp of the one before" in values["reason"]


def test_no_stamps_and_no_clock_are_told_with_the_reason(graph, log, sent, made_footage):
    node = graph.add(
        TrackerNode(
            context=graph.context,
            tap=lambda *output: sent.append(output),
            parameter_overrides=[
                Parameter("use_sim_time", value=True),
                Parameter("image_timeout", value=TIMEOUT),
            ],
        )
    )
    unstamped = image_message(made_footage[0][0], header_at(0))

    def told() -> bool:
        node.on_image(unstamped)
        return any("/clock" in text for text in warnings(log))

    graph.spin_until(told, "the warning")
    assert any("nobody publishes /clock" in text for text in warnings(log))
    graph.spin_until(
        lambda: told() and "stamp" in status_values(statuses(sent)[-1])["reason"], "the status"
    )


@pytest.mark.parametrize(
    "counted, says",
    [
        ({}, "no image for 7.0 s"),
        ({"duplicate": 5}, "5 came with the stamp of the one before"),
        ({"late": 3}, "3 came with older stamps"),
        ({"unreadable": 2}, "2 could not be read"),
    ],
)
def test_reasons(counted, says):
    clock, counts = Clock(), Counter(duplicate=9, late=9, unreadable=9)
    watch = Watch(lambda: counts, clock)
    assert not watch.due(5.0, 1.0)
    counts.update(counted)
    clock.now += 7
    assert watch.due(5.0, 1.0) and not watch.due(5.0, 1.0)
    assert says in watch.reason()
    clock.now += 1
    assert watch.due(5.0, 1.0)
    assert watch.begin() == 8 and not watch.told


# Levels --------------------------------------------------------------------------------------


def test_one_level_a_state_everywhere():
    assert {state.value: level for state, level in LEVELS.items()} == {
        "IDLE": DiagnosticStatus.OK,
        "TRACKING": DiagnosticStatus.OK,
        "COASTING": DiagnosticStatus.WARN,
        "LOST": DiagnosticStatus.ERROR,
    }
    assert level_of(State.IDLE, trouble=True) == DiagnosticStatus.WARN
    assert level_of(State.LOST, trouble=True) == DiagnosticStatus.ERROR


def test_the_score_is_a_number_on_a_topic_of_its_own(graph, made_footage):
    got = []
    node = graph.add(TrackerNode(context=graph.context))
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(Float32, "tracker/score", got.append, 50)
    graph.spin_until(lambda: node._outputs.heard("score"), "discovery")
    follow(node, made_footage)
    graph.spin_until(lambda: len(got) == 4, "a score for each status")
    assert got[0].data == 0  # IDLE
    assert all(0 < message.data <= 1 for message in got[1:])


# Inputs that do not come ---------------------------------------------------------------------


@pytest.mark.parametrize(
    "output, kind, comes, missing",
    [
        ("bearing", Vector3Stamped, None, "/camera_info"),
        ("target_pose", PoseStamped, None, "/camera_info"),
        ("target_pose", PoseStamped, CameraInfo(), "/depth"),
    ],
)
def test_an_output_that_waits_for_an_input_says_which(
    graph, log, monkeypatch, output, kind, comes, missing
):
    monkeypatch.setattr(input_hints, "PATIENCE", 0.1)
    node = graph.add(TrackerNode(context=graph.context))
    if comes is not None:
        node.space.on_camera_info(comes)
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(kind, f"tracker/{output}", print, 10)

    def hints():
        return [text for text in warnings(log) if f"nothing comes on {missing}," in text]

    graph.spin_until(hints, "the hint")
    graph.settle(30)
    assert len(hints()) == 1
    assert f"~/{output}" in hints()[0] and f"-r {missing[1:]}:=" in hints()[0]


def test_who_gets_what_he_asks_for_hears_no_hint(graph, log, monkeypatch):
    monkeypatch.setattr(input_hints, "PATIENCE", 0.1)
    node = graph.add(TrackerNode(context=graph.context))
    node.space.on_camera_info(CameraInfo())
    viewer = graph.add(Node("viewer", context=graph.context))
    viewer.create_subscription(Vector3Stamped, "tracker/bearing", print, 10)
    graph.spin_until(lambda: node._outputs.heard("bearing"), "discovery")
    graph.settle(30)
    assert not [text for text in warnings(log) if "nothing comes on" in text]


# What to start it with instead ---------------------------------------------------------------


@pytest.mark.parametrize(
    "kind, published, asked, says",
    [
        (CompressedImage, "/cam/compressed", ("/cam", "Image"), "image_transport:=compressed"),
        (
            CompressedImage,
            "/cam/compressed",
            ("/cam/compressed", "Image"),
            "-r image:=/cam -p image_transport:=compressed",
        ),
        (Image, "/cam", ("/cam/compressed", "CompressedImage"), "image_transport:=raw"),
        (Image, "/cam", ("/image", "Image"), "-r image:=/cam (Image is on /cam)"),
        (Image, "/cam", ("/cam", "Image"), "camera (sensor_msgs/msg/Image, reliable)"),
    ],
)
def test_the_way_out_is_named(graph, kind, published, asked, says):
    camera = graph.add(Node("camera", context=graph.context))
    camera.create_publisher(kind, published, 10)
    asking = graph.add(Node("asking", context=graph.context))
    graph.spin_until(lambda: asking.count_publishers(published) > 0, "discovery")
    assert says in waiting_on(asking, *asked, "best_effort")


# What is done is logged ----------------------------------------------------------------------


def test_what_is_done_is_logged(graph, node, log, made_footage):
    follow(node, made_footage)
    node._on_enable(SetBool.Request(data=False), SetBool.Response())
    node._on_enable(SetBool.Request(data=True), SetBool.Response())
    node._on_reset(Trigger.Request(), Trigger.Response())
    node.set_parameters_atomically([Parameter("sub_patches", value=4)])
    node.trigger_deactivate()
    said = " | ".join(text for level, text in log if level == "info")
    for words in (
        "enable: images are ignored",
        "enable: images are processed",
        "reset: was TRACKING, now IDLE",
        "sub_patches: takes effect with the next box",
        "deactivated",
    ):
        assert words in said
