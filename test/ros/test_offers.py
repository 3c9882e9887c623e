# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Images and depth are asked for as reliably as all their publishers offer."""

import itertools

import pytest
from rclpy.duration import Duration
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image

from het_ros.ros.quality import setting
from het_ros.ros.tracker_node import TrackerNode

from .streams import header_at, image_message

RELIABLE = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def asked(node, topic="/image"):
    """What a node asks for on a topic; None while it changes."""
    found = {s.qos_profile.reliability.name for s in node.subscriptions if s.topic_name == topic}
    return found.pop() if len(found) == 1 else None


@pytest.mark.parametrize("topic", ["/image", "/depth"])
@pytest.mark.parametrize(
    "offered, expected",
    [
        ([RELIABLE], "RELIABLE"),
        ([BEST_EFFORT], "BEST_EFFORT"),
        ([RELIABLE, BEST_EFFORT], "BEST_EFFORT"),
    ],
)
def test_what_is_offered_is_asked_for(graph, topic, offered, expected):
    node = graph.add(TrackerNode(context=graph.context))
    assert asked(node, topic) == "BEST_EFFORT"  # which hears everybody
    camera = graph.add(Node("camera", context=graph.context))
    for qos in offered:
        camera.create_publisher(Image, topic, qos)
    graph.spin_until(lambda: node.count_publishers(topic) == len(offered), "discovery")
    graph.spin_until(lambda: asked(node, topic) == expected, "what is asked for")


def test_a_camera_that_was_there_before_is_asked_at_once(graph):
    camera = graph.add(Node("camera", context=graph.context))
    camera.create_publisher(Image, "image", RELIABLE)
    graph.spin_until(lambda: camera.count_publishers("image") > 0, "discovery")
    assert asked(graph.add(TrackerNode(context=graph.context))) == "RELIABLE"


def test_another_camera_that_offers_less_is_heard_as_well(graph, capfd):
    node = graph.add(TrackerNode(context=graph.context))
    camera = graph.add(Node("camera", context=graph.context))
    camera.create_publisher(Image, "image", RELIABLE)
    graph.spin_until(lambda: asked(node) == "RELIABLE", "reliable")
    camera.create_publisher(Image, "image", BEST_EFFORT)
    graph.spin_until(lambda: asked(node) == "BEST_EFFORT", "best effort")
    said = capfd.readouterr().err
    assert said.count("/image is asked for reliable") == 1
    assert said.count("/image is asked for best_effort") == 1


def test_no_image_is_lost_or_doubled_by_the_change(graph, made_footage):
    node = graph.add(TrackerNode(context=graph.context))
    came = []
    node.images.join(lambda frame: came.append(frame.stamp))
    camera = graph.add(Node("camera", context=graph.context))
    images = camera.create_publisher(Image, "image", RELIABLE)
    graph.spin_until(lambda: images.get_subscription_count() > 0, "discovery")
    changed = 0
    for i in itertools.count():
        images.publish(image_message(made_footage[0][0], header_at(1 + i / 30)))
        graph.spin_until(lambda i=i: len(came) > i, "the image")
        changed += asked(node) == "RELIABLE"
        if changed == 20:
            break
    assert len(came) == len(set(came)) == i + 1


@pytest.mark.parametrize(
    "parameter", ["reliability", "qos_overrides./image.subscription.reliability"]
)
@pytest.mark.parametrize("value", ["reliable", "best_effort"])
def test_it_can_be_fixed(graph, parameter, value):
    camera = graph.add(Node("camera", context=graph.context))
    camera.create_publisher(Image, "image", BEST_EFFORT if value == "reliable" else RELIABLE)
    graph.spin_until(lambda: camera.count_publishers("image") > 0, "discovery")
    node = graph.add(
        TrackerNode(context=graph.context, parameter_overrides=[Parameter(parameter, value=value)])
    )
    graph.settle(40)
    assert asked(node) == value.upper()


def test_a_clash_names_the_value(graph, monkeypatch):
    heard = []
    monkeypatch.setattr(RcutilsLogger, "warning", lambda _, text, **__: heard.append(text))
    fixed = Parameter("reliability", value="reliable")
    graph.add(TrackerNode(context=graph.context, parameter_overrides=[fixed]))
    camera = graph.add(Node("camera", context=graph.context))
    camera.create_publisher(Image, "image", BEST_EFFORT)
    graph.spin_until(lambda: any("reliability" in text for text in heard), "the explanation")
    assert any(
        "-p qos_overrides./image.subscription.reliability:=best_effort" in text for text in heard
    )


@pytest.mark.parametrize(
    "profiles, policy, least, value",
    [
        ([RELIABLE, BEST_EFFORT], "reliability", True, "best_effort"),
        ([RELIABLE, BEST_EFFORT], "reliability", False, "reliable"),
        ([], "reliability", True, "best_effort"),
        (
            [QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)],
            "durability",
            False,
            "transient_local",
        ),
        ([QoSProfile(depth=1, deadline=Duration(seconds=2))], "deadline", True, "2000000000"),
    ],
)
def test_the_value_that_fits_all(profiles, policy, least, value):
    assert setting(profiles, policy, least) == value
