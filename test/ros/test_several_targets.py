# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Several nodes in one process on one stream of images."""

import numpy as np
import pytest
from geometry_msgs.msg import PolygonStamped
from rclpy.node import Node
from sensor_msgs.msg import CompressedImage, Image

from het_ros import Box
from het_ros.ros import frames as frames_module
from het_ros.ros.messages import box_from_polygon
from het_ros.ros.tracker_node import TrackerNode

from .streams import FRAME_TIME, ByHand, box_message, header_at, image_message
from .test_images import compressed


@pytest.fixture
def pair(graph):
    """Two nodes, the second on the images of the first."""
    left = ByHand(graph, name="left")
    right = ByHand(graph, name="right", source=left.node)
    return left, right


def test_each_has_its_own_target_and_images_are_converted_once(pair, made_footage, monkeypatch):
    frames, box = made_footage
    left, right = pair
    converted = []
    real = frames_module.array_of
    monkeypatch.setattr(
        frames_module, "array_of", lambda m, white: converted.append(1) or real(m, white)
    )
    left.image(frames[0], 1.0)
    left.box(box)
    right.box((100, 60, 30, 40))
    del converted[:]
    for i in range(1, 10):
        del right.sent[:]
        outputs = left.image(frames[i], 1 + i * FRAME_TIME)
    assert len(converted) == 9
    mine, theirs = (box_from_polygon(dict(sent)["box"]) for sent in (outputs.items(), right.sent))
    assert mine.iou(Box(38, 44, 20, 32)) > 0.6
    assert theirs.iou(Box(100, 60, 30, 40)) > 0.6


def test_the_same_as_alone(graph, pair, made_footage):
    frames, box = made_footage
    left, right = pair
    alone = ByHand(graph, name="alone")
    for i in range(10):
        outputs = alone.image(frames[i], 1 + i * FRAME_TIME)
        left.image(frames[i], 1 + i * FRAME_TIME)
        if i == 0:
            alone.box(box)
            right.box(box)
    boxes = [m for topic, m in right.sent if topic == "box"]
    assert box_from_polygon(boxes[-1]) == box_from_polygon(outputs["box"])


def test_the_ring_keeps_no_converted_pixels(graph, made_footage):
    leader = ByHand(
        graph, name="left", cli_args=["--ros-args", "-p", "image_transport:=compressed"]
    )
    ByHand(graph, name="right", source=leader.node)
    for i, pixels in enumerate(made_footage[0][:5]):
        message = compressed(pixels, "png")
        message.header = header_at(1 + i * FRAME_TIME)
        leader.feed(message)
    kept = leader.node._pursuit._ring._frames
    assert all(isinstance(frame.message, CompressedImage) for frame in kept)
    assert not any(frame.shared._pixels for frame in kept)


def test_a_disabled_leader_still_feeds_the_others(pair, made_footage):
    left, right = pair
    left.node._enabled = False
    left.image(made_footage[0][0], 1.0)
    assert not left.sent
    assert dict(right.sent)["status"].header == header_at(1.0)


@pytest.mark.parametrize("off", ["left", "right"])
def test_either_may_be_switched_off(pair, made_footage, off):
    """Images come in while any node is active; each transition leaves the other's as they are."""
    nodes = dict(zip(("left", "right"), pair, strict=True))
    gone = nodes.pop(off)
    (stays,) = nodes.values()

    def subscriptions() -> int:
        return sum(s.topic_name == "/image" for hand in pair for s in hand.node.subscriptions)

    gone.node.trigger_deactivate()
    assert subscriptions() == 1
    stays.image(made_footage[0][0], 1.0)
    assert dict(stays.sent)["status"].header == header_at(1.0)
    assert not gone.sent
    stays.node.trigger_deactivate()
    assert subscriptions() == 0
    gone.node.trigger_activate()
    gone.image(made_footage[0][1], 2.0)
    assert gone.sent
    stays.node.trigger_activate()
    gone.node.destroy_node()
    stays.image(made_footage[0][2], 3.0)
    assert dict(stays.sent)["status"].header == header_at(3.0)


def test_one_process_hosts_them(processes, local_graph, made_footage):
    frames, box = made_footage
    processes("tracker", "--targets", "left,right")
    got: dict[str, list] = {"left": [], "right": []}
    camera = local_graph.add(Node("camera", context=local_graph.context))
    images = camera.create_publisher(Image, "image", 10)
    boxes = [camera.create_publisher(PolygonStamped, f"{name}/init_box", 10) for name in got]
    for name, kept in got.items():
        camera.create_subscription(PolygonStamped, f"{name}/box", kept.append, 10)
    publishers = [images, *boxes]
    local_graph.spin_until(
        lambda: (
            all(p.get_subscription_count() for p in publishers)
            and all(camera.count_publishers(f"{name}/box") for name in got)
        ),
        "both nodes",
    )
    assert images.get_subscription_count() == 1
    for publisher, wanted in zip(boxes, (box, (100, 60, 30, 40)), strict=True):
        publisher.publish(box_message(wanted))
    stamps = iter(np.arange(1, 1000, FRAME_TIME))

    def both() -> bool:
        images.publish(image_message(frames[0], header_at(float(next(stamps)))))
        return all(got.values())

    local_graph.spin_until(both, "a box of each")
    assert box_from_polygon(got["left"][0]).iou(Box(*box)) > 0.8
    assert box_from_polygon(got["right"][0]).iou(Box(100, 60, 30, 40)) > 0.8


def test_a_wrong_name_is_refused(processes):
    tracker = processes("tracker", "--targets", "left,not-a-name")
    assert tracker.wait() == 2
    assert "not-a-name" in tracker.log.read_text()


def test_nodes_by_default_are_alone(graph):
    first, second = (graph.add(TrackerNode(name, context=graph.context)) for name in "ab")
    assert first.images is not second.images
