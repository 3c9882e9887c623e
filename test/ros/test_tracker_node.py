# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import cv2
import numpy as np
import pytest
from geometry_msgs.msg import PolygonStamped
from graph import PATIENCE
from rclpy.parameter import Parameter
from sensor_msgs.msg import CompressedImage, Image, RegionOfInterest
from std_srvs.srv import SetBool, Trigger

from het_ros import Box
from het_ros.ros.messages import box_from_polygon
from het_ros.ros.status import status_values
from het_ros.ros.tracker_node import TrackerNode

from .streams import FRAME_TIME, ByHand, Camera, box_message, header_at, image_message


@pytest.fixture
def hand(graph):
    return ByHand(graph)


def started(hand, made_footage, until: int = 3) -> list:
    """Start on the first frame and follow to ``until``; the frames."""
    frames, box = made_footage
    hand.image(frames[0], 1.0)
    hand.box(box)
    for i in range(1, until):
        assert hand.state_of(hand.image(frames[i], 1 + i * FRAME_TIME)) == "TRACKING"
    return frames


def test_a_box_and_images_over_ros_give_box_pose_velocity_and_status(graph, made_footage):
    frames, box = made_footage
    graph.add(TrackerNode(context=graph.context))
    camera = graph.add(Camera(context=graph.context))
    camera.meet(graph)
    header = header_at(5.0, "optical")
    camera.show(graph, image_message(frames[0], header))
    assert status_values(camera.got["status"][0])["state"] == "IDLE"
    assert not camera.got["box"]

    camera.boxes.publish(box_message(box, header))
    graph.spin_until(lambda: camera.got["velocity"], "the first estimate")
    for i in range(1, 15):
        camera.show(graph, image_message(frames[i], header_at(5 + i * FRAME_TIME, "optical")))
    graph.spin_until(lambda: len(camera.got["velocity"]) == 15, "a velocity a frame")

    for topic in ("box", "pose", "velocity", "status"):
        last = camera.got[topic][-1].header
        assert last == header_at(5 + 14 * FRAME_TIME, "optical"), topic
    followed = box_from_polygon(camera.got["box"][-1])
    assert followed.iou(Box(20 + 2 * 14, 40 + 7, 20, 32)) > 0.6
    position = camera.got["pose"][-1].pose.pose.position
    assert (position.x, position.y) == pytest.approx(followed.centre, abs=1e-3)
    assert camera.got["velocity"][-1].twist.twist.linear.x == pytest.approx(60, abs=30)
    values = status_values(camera.got["status"][-1])
    assert values["state"] == "TRACKING"
    assert 0 < float(values["score"]) <= 1
    assert float(values["latency_ms"]) > 0


def test_compressed_images(graph, made_footage):
    frames, box = made_footage
    hand = ByHand(graph, parameter_overrides=[Parameter("image_transport", value="compressed")])
    for i in range(8):
        jpeg = cv2.imencode(".jpg", frames[i], [cv2.IMWRITE_JPEG_QUALITY, 95])[1].tobytes()
        message = CompressedImage(format="jpeg", data=jpeg, header=header_at(1 + i * FRAME_TIME))
        outputs = hand.feed(message)
        if i == 0:
            outputs = hand.box(box, 1.0)
        assert hand.state_of(outputs) == "TRACKING"
    assert box_from_polygon(outputs["box"]).iou(Box(34, 43, 20, 32)) > 0.6
    topics = dict(hand.node.get_subscriber_names_and_types_by_node("tracker", "/"))
    assert topics["/image/compressed"] == ["sensor_msgs/msg/CompressedImage"]
    assert "/image" not in topics


def test_real_footage(graph, sequences):
    hand = ByHand(graph)
    images = sorted((sequences / "Crossing" / "img").glob("*.jpg"))[:40]
    truth = np.loadtxt(sequences / "Crossing" / "groundtruth_rect.txt", delimiter="\t")[:40]
    truth[:, :2] -= 1
    overlaps = []
    for i, (file, box) in enumerate(zip(images, truth, strict=True)):
        outputs = hand.image(cv2.imread(str(file)), 1 + i * FRAME_TIME)
        if i == 0:
            outputs = hand.box(box)
        overlaps.append(box_from_polygon(outputs["box"]).iou(Box(*box)))
    assert np.mean(overlaps) > 0.55


def test_a_box_before_any_image_starts_on_the_first(hand, made_footage):
    frames, box = made_footage
    assert hand.box(box) == {}
    outputs = hand.image(frames[0], 1.0)
    assert hand.state_of(outputs) == "TRACKING"
    assert box_from_polygon(outputs["box"]).as_tuple() == pytest.approx(box)


def test_a_box_for_an_image_to_come_waits_for_it(hand, made_footage):
    frames, _ = made_footage
    hand.image(frames[0], 1.0)
    assert hand.box((24, 41, 20, 32), 1 + 2 * FRAME_TIME) == {}
    assert hand.state_of(hand.image(frames[1], 1 + FRAME_TIME)) == "IDLE"
    assert hand.state_of(hand.image(frames[2], 1 + 2 * FRAME_TIME)) == "TRACKING"


def test_a_region_starts_a_track_too(hand, made_footage):
    frames, (x, y, w, h) = made_footage
    hand.image(frames[0], 1.0)
    hand.node.on_init_roi(RegionOfInterest(x_offset=x, y_offset=y, width=w, height=h))
    assert hand.state_of(hand.image(frames[1], 1 + FRAME_TIME)) == "TRACKING"


@pytest.mark.parametrize(
    "box",
    [
        (math.nan, 1, 20, 20),
        (1, 1, math.inf, 20),
        (10, 10, 3.9, 4),
        (500, 10, 20, 20),
        (-100, -100, 20, 20),
        (0, 0, 1e30, 1e30),
    ],
)
def test_a_refused_box_and_the_running_track_goes_on(hand, made_footage, box):
    frames = started(hand, made_footage)
    assert hand.box(box) == {}
    outputs = hand.image(frames[3], 1 + 3 * FRAME_TIME)
    assert hand.state_of(outputs) == "TRACKING"
    assert box_from_polygon(outputs["box"]).iou(Box(26, 41, 20, 32)) > 0.6


def test_a_polygon_of_one_point_is_refused(hand, made_footage):
    frames = started(hand, made_footage)
    message = PolygonStamped()
    message.polygon.points = box_message((1, 1, 30, 30)).polygon.points[:1]
    hand.node.on_init_box(message)
    assert hand.state_of(hand.image(frames[3], 1 + 3 * FRAME_TIME)) == "TRACKING"


def test_a_new_box_replaces_the_track(hand, made_footage):
    frames = started(hand, made_footage)
    outputs = hand.box((100, 60, 24, 24))
    assert box_from_polygon(outputs["box"]).as_tuple() == (100, 60, 24, 24)
    outputs = hand.image(frames[3], 1 + 3 * FRAME_TIME)
    assert box_from_polygon(outputs["box"]).iou(Box(100, 60, 24, 24)) > 0.6


def test_in_lost_there_is_nothing_but_status(hand, made_footage):
    frames = started(hand, made_footage)
    for i in range(3):
        outputs = hand.image(frames[4 + i], 10 + i * FRAME_TIME)  # after a gap of 9 s
        assert set(outputs) == {"status", "score"}
        values = status_values(outputs["status"])
        assert values["state"] == "LOST"
        assert "no image for" in values["reason"]
        assert float(values["score"]) == 0
    assert set(hand.box((34, 43, 20, 32))) == {
        "box",
        "pose",
        "velocity",
        "velocity_in_scene",
        "status",
        "score",
    }


def test_a_target_that_goes_for_good_is_lost_and_silent(hand, made_footage):
    frames = started(hand, made_footage, until=10)
    ground = np.full_like(frames[0], 127)
    states = []
    for i in range(10, 200):
        outputs = hand.image(ground, 1 + i * FRAME_TIME)
        states.append(hand.state_of(outputs))
        assert ("box" in outputs) == (states[-1] in ("TRACKING", "COASTING"))
    assert states[-1] == "LOST"


def test_duplicates_and_late_frames_are_dropped(hand, made_footage):
    frames = started(hand, made_footage, until=5)
    assert hand.image(frames[4], 1 + 4 * FRAME_TIME) == {}
    assert hand.image(frames[2], 1 + 2 * FRAME_TIME) == {}
    assert hand.state_of(hand.image(frames[5], 1 + 5 * FRAME_TIME)) == "TRACKING"


def test_time_that_jumps_back_resets_the_track(hand, made_footage):
    frames, box = made_footage
    for _ in range(2):  # a bag in a loop
        outputs = hand.image(frames[0], 10.0)
        if hand.node.reason == "time jumped back":
            assert hand.state_of(outputs) == "IDLE"
        assert hand.state_of(hand.box(box, 10.0)) == "TRACKING"
        for i in range(1, 10):
            assert hand.state_of(hand.image(frames[i], 10 + i / 5)) != "IDLE"


def test_images_without_a_stamp_are_stamped_on_arrival(hand, made_footage):
    frames, box = made_footage
    hand.image(frames[0], 0)
    hand.box(box)
    outputs = hand.image(frames[1], 0)
    assert hand.state_of(outputs) == "TRACKING"
    assert outputs["box"].header == header_at(0)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda image: setattr(image, "encoding", "vapour"),
        lambda image: setattr(image, "data", bytes(image.data[:-100])),
        lambda image: setattr(image, "height", 0),
    ],
)
def test_an_unreadable_image_is_left_out(hand, made_footage, spoil):
    frames = started(hand, made_footage)
    bad = image_message(frames[3], header_at(1 + 3 * FRAME_TIME))
    spoil(bad)
    assert hand.feed(bad) == {}
    assert hand.state_of(hand.image(frames[4], 1 + 4 * FRAME_TIME)) == "TRACKING"


def test_encodings_that_are_made_up_are_told_once(hand, made_footage, capfd):
    frames, _ = made_footage
    for i in range(50):
        image = image_message(frames[0], header_at(1 + i * FRAME_TIME))
        image.encoding = f"invented{i}"
        hand.feed(image)
    assert capfd.readouterr().err.count("image refused") == 1


def test_stamps_that_jump_for_ever_do_not_fill_the_log(hand, made_footage, capfd):
    frames, _ = made_footage
    for i in range(200):
        hand.image(frames[0], 10.0 if i % 2 else 20.0)
    assert 0 < capfd.readouterr().err.count("jumped back") <= 20


def test_an_image_larger_than_allowed_is_refused(graph, made_footage):
    frames, _ = made_footage
    limit = Parameter("max_megapixels", value=0.019)  # the frames have 0.0192
    hand = ByHand(graph, parameter_overrides=[limit])
    assert hand.image(frames[0], 1.0) == {}
    assert hand.node._pursuit.counts["unreadable"] == 1
    assert hand.state_of(hand.image(frames[1][:100], 1 + FRAME_TIME)) == "IDLE"


def test_a_compressed_image_larger_than_allowed_starts_no_track(graph, made_footage):
    """Without a track images are not decoded: the box is what meets the large one."""
    frames, box = made_footage
    options = {"image_transport": "compressed", "max_megapixels": 0.0193}
    hand = ByHand(graph, parameter_overrides=[Parameter(k, value=v) for k, v in options.items()])
    for i, pixels in enumerate((frames[0], cv2.resize(frames[1], (320, 240)))):
        png = cv2.imencode(".png", pixels)[1].tobytes()
        header = header_at(1 + i * FRAME_TIME)
        hand.feed(CompressedImage(format="png", data=png, header=header))
    assert hand.box(box) == {}
    assert hand.node.state.value == "IDLE"
    hand.box(box, 1.0)
    assert hand.node.state.value == "TRACKING"


def test_an_image_of_another_size_loses_the_track(hand, made_footage):
    frames = started(hand, made_footage)
    outputs = hand.image(cv2.resize(frames[3], (80, 60)), 1 + 3 * FRAME_TIME)
    assert set(outputs) == {"status", "score"}
    assert "80 x 60" in status_values(outputs["status"])["reason"]


def test_a_fault_in_the_tracker_is_a_loss_not_a_crash(hand, made_footage, monkeypatch):
    frames = started(hand, made_footage)

    def broken(*_):
        raise FloatingPointError("on purpose")

    monkeypatch.setattr("het_ros.ros.session.HierarchicalEnsembleTracker.update", broken)
    outputs = hand.image(frames[3], 1 + 3 * FRAME_TIME)
    assert hand.state_of(outputs) == "LOST"
    assert "on purpose" in status_values(outputs["status"])["reason"]


def call(graph, kind, name, request):
    client = graph.nodes[-1].create_client(kind, name)
    assert client.wait_for_service(PATIENCE)
    future = client.call_async(request)
    graph.spin_until(future.done, name)
    return future.result()


def test_services_reset_and_enable(graph, hand, made_footage):
    frames = started(hand, made_footage)
    graph.executor.add_node(hand.node)
    graph.add(Camera(context=graph.context))
    answer = call(graph, Trigger, "tracker/reset", Trigger.Request())
    assert answer.success
    assert "TRACKING" in answer.message
    assert hand.state_of(hand.image(frames[3], 1 + 3 * FRAME_TIME)) == "IDLE"

    hand.box((26, 41, 20, 32))
    assert call(graph, SetBool, "tracker/enable", SetBool.Request(data=False)).success
    assert hand.image(frames[4], 1 + 4 * FRAME_TIME) == {}
    assert hand.box((0, 0, 20, 20)) == {}
    assert call(graph, SetBool, "tracker/enable", SetBool.Request(data=True)).success
    outputs = hand.image(frames[5], 1 + 5 * FRAME_TIME)  # a short pause: the track is kept
    assert hand.state_of(outputs) == "TRACKING"


def test_a_pause_longer_than_max_gap_loses_the_track(hand, made_footage):
    frames = started(hand, made_footage)
    hand.node.trigger_deactivate()
    assert hand.image(frames[3], 1 + 3 * FRAME_TIME) == {}
    hand.node.trigger_activate()
    assert hand.state_of(hand.image(frames[4], 1 + 4 * FRAME_TIME)) == "TRACKING"
    hand.node.trigger_deactivate()
    hand.node.trigger_activate()
    assert hand.state_of(hand.image(frames[5], 9.0)) == "LOST"


def test_lifecycle_by_a_manager(graph, made_footage):
    frames, box = made_footage
    hand = ByHand(graph, parameter_overrides=[Parameter("autostart", value=False)])
    assert hand.image(frames[0], 1.0) == {}
    for _ in range(2):
        hand.node.trigger_configure()
        hand.node.trigger_activate()
        assert hand.state_of(hand.image(frames[0], 1.0)) == "IDLE"
        assert hand.state_of(hand.box(box)) == "TRACKING"
        hand.node.trigger_deactivate()
        hand.node.trigger_cleanup()
        assert hand.node.state.value == "IDLE"


def test_nothing_is_made_for_nobody(graph, made_footage, monkeypatch):
    frames, box = made_footage
    node = graph.add(TrackerNode(context=graph.context))

    def refuse(*_):
        raise AssertionError("a message was made although nobody listens")

    for name in (
        "polygon_from_box",
        "pose_from_estimate",
        "twist_from_estimate",
        "status_message",
    ):
        monkeypatch.setattr(f"het_ros.ros.answers.{name}", refuse)
    node.on_image(image_message(frames[0], header_at(1.0)))
    node.on_init_box(box_message(box))
    node.on_image(image_message(frames[1], header_at(1 + FRAME_TIME)))
    assert node.state.value == "TRACKING"


@pytest.mark.parametrize(
    "fault, key",
    [
        (lambda hand, frames: hand.feed(Image(encoding="vapour", width=1, height=1)), "vapour"),
        (lambda hand, frames: hand.box((20, 40, 20, 32)), "before any image"),
        (lambda hand, frames: hand.image(frames[0], 0), "no stamp"),
    ],
)
def test_hints_are_given_once(hand, made_footage, monkeypatch, fault, key):
    heard = []
    monkeypatch.setattr(
        type(hand.node.get_logger()), "warning", lambda _, text: heard.append(text)
    )
    for _ in range(3):
        fault(hand, made_footage[0])
    assert len([text for text in heard if key in text]) == 1
