# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What others may send to the installed tracker: too many boxes, too many calls, too large."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from geometry_msgs.msg import PolygonStamped
from rcl_interfaces.srv import GetParameters
from ros.streams import Camera, image_message
from sensor_msgs.msg import CompressedImage, Image
from std_srvs.srv import SetBool

from het_ros import Box
from het_ros.bench.process import usage
from het_ros.faults.process import look
from het_ros.ros.messages import polygon_from_box

from .lockstep import crossing, header, pixels_of

FLOOD = 1000  # at once, again with every frame
MOST_MORE = 60.0  # MB that the node may hold more; one 8k image is 100


@pytest.fixture
def steady_memory(lockstep):
    """The node holds no more memory at the end than at the beginning, but for MOST_MORE."""
    stream = lockstep.steady(5)
    lockstep.follow(stream)
    lockstep.begin()
    before = look(lockstep.pid)
    yield
    after = look(lockstep.pid)
    assert after.own_mb - before.own_mb < MOST_MORE
    assert after.threads == before.threads and after.files <= before.files + 2


def flood(lockstep, send, frames: int = 20) -> None:
    """Follow the crossing while ``send()`` is called FLOOD times before every frame."""
    stream = lockstep.steady(frames)
    lockstep.play(stream[:1])
    lockstep.start(stream[0])
    for delivery in stream[1:]:
        for _ in range(FLOOD // frames * 3):
            send(delivery)
        lockstep.send(delivery)


def test_a_flood_of_boxes(lockstep, steady_memory):
    """Every frame is answered, and the last box is the one that is followed."""
    truth = lockstep.footage.truth

    def send(delivery) -> None:
        lockstep.camera.boxes.publish(
            polygon_from_box(truth[delivery.frame - 1], header(delivery.stamp - 33_333_333))
        )

    flood(lockstep, send)
    lockstep.graph.settle()
    assert lockstep.state() == "TRACKING"


def test_a_flood_of_wrong_boxes(lockstep, steady_memory):
    """They are refused, the track goes on, and the log does not fill the disk."""
    rng = np.random.default_rng(0)
    wrong = [
        PolygonStamped(),
        polygon_from_box(Box(1e6, 1e6, 50, 50), header(0)),
        polygon_from_box(Box(10, 10, 1, 1), header(0)),
        polygon_from_box(Box(0, 0, 1e5, 1e5), header(0)),
    ]
    before = len(lockstep.log.read_text().splitlines())
    flood(lockstep, lambda _: lockstep.camera.boxes.publish(wrong[rng.integers(len(wrong))]))
    lockstep.graph.settle()
    assert lockstep.state() == "TRACKING"
    assert np.mean(lockstep.overlaps(lockstep.steady(20))) > 0.5
    lines = lockstep.log.read_text().splitlines()[before:]
    # One line in some seconds; how many that makes depends on how long the flood takes here.
    assert 1 <= sum("init box refused" in line for line in lines) < FLOOD / 5


def test_a_flood_of_calls(lockstep, steady_memory):
    """Services called 1000 times and more a second are answered, and so is every frame."""
    camera = lockstep.camera
    enable = camera.create_client(SetBool, "tracker/enable")
    parameters = camera.create_client(GetParameters, "tracker/get_parameters")
    for client in (enable, parameters):
        lockstep.graph.spin_until(client.service_is_ready, "the service")
    answers = []

    def call(_) -> None:
        if len(answers) % 2:
            answers.append(enable.call_async(SetBool.Request(data=True)))
        else:
            answers.append(parameters.call_async(GetParameters.Request(names=["max_gap"])))

    flood(lockstep, call)
    assert np.mean(lockstep.overlaps(lockstep.steady(20))) > 0.5
    # A service keeps the newest 10 requests that wait: how many of a flood are answered is up to
    # the machine, but all of those that wait for their answer are.
    lockstep.graph.spin_until(lambda: sum(a.done() for a in answers) >= 10, "answers")
    lockstep.graph.settle()
    for _ in range(50):
        for client, request in (
            (enable, SetBool.Request(data=True)),
            (parameters, GetParameters.Request(names=["max_gap"])),
        ):
            lockstep.graph.spin_until(client.call_async(request).done, "an answer afterwards")


def test_images_that_claim_to_be_huge(lockstep, steady_memory):
    """100 megapixels in the header, nothing or little behind it: refused, the track goes on."""
    stream = lockstep.steady(10)
    lockstep.play(stream[:1])
    lockstep.start(stream[0])
    claims = ((10000, 10000, b""), (2**32 - 1, 2**32 - 1, b"12"), (1, 2**31, b""))
    for number, (width, height, data) in enumerate(claims, 1):
        lockstep.camera.images.publish(
            Image(
                header=header(stream[0].stamp + number),
                width=width,
                height=height,
                encoding="bgr8",
                step=min(3 * width, 2**32 - 1),
                data=data,
            )
        )
        lockstep.sent += 1
        lockstep.all_counted()
    assert lockstep.counted("unreadable") == 3
    lockstep.play(stream[1:])
    assert lockstep.state() == "TRACKING"
    assert np.mean(lockstep.overlaps(stream)) > 0.5


def test_a_huge_picture_in_few_bytes(sequences, processes, local_graph):
    """144 megapixels as a PNG of half a megabyte: refused by its header, before it is decoded."""
    bomb = cv2.imencode(".png", np.zeros((12000, 12000), np.uint8))[1].tobytes()
    assert len(bomb) < 500_000
    tracker = processes("tracker", "--ros-args", "-p", "image_transport:=compressed")
    camera = local_graph.add(Camera(compressed=True, context=local_graph.context))
    camera.meet(local_graph)
    footage = crossing(sequences)

    def jpeg(frame: int, stamp: int) -> CompressedImage:
        data = cv2.imencode(".jpg", pixels_of(footage, frame))[1].tobytes()
        return CompressedImage(header=header(stamp), format="jpeg", data=data)

    camera.show(local_graph, jpeg(0, 10**9))
    camera.boxes.publish(polygon_from_box(footage.truth[0], header(10**9)))
    local_graph.spin_until(lambda: camera.got["box"], "the first box")
    before = look(tracker.pid)
    for i in range(3):
        camera.images.publish(
            CompressedImage(header=header(10**9 + 1 + i), format="png", data=bomb)
        )
    local_graph.spin_until(lambda: "image refused" in tracker.log.read_text(), "the refusal")
    assert "max_megapixels" in tracker.log.read_text()
    for frame in range(1, 6):
        camera.show(local_graph, jpeg(frame, 10**9 + frame * 33_333_333))
    assert look(tracker.pid).own_mb - before.own_mb < MOST_MORE
    assert peak_mb(tracker.pid) - before.rss_mb < MOST_MORE
    assert len(camera.got["box"]) >= 5


def test_an_8k_image(lockstep):
    """33 megapixels are within max_megapixels: taken, and the ring stays within its memory."""
    big = np.zeros((4320, 7680), np.uint8)
    cv2.randu(big, 0, 255)
    stream = lockstep.steady(6)
    for delivery in stream[:3]:
        message = image_message(big, header(delivery.stamp))
        lockstep.camera.images.publish(message)
        lockstep.graph.spin_until(lambda d=delivery: answered(lockstep, d), "a status for 8k")
    lockstep.play(stream[3:4])
    lockstep.start(stream[3])
    lockstep.play(stream[4:])
    assert lockstep.state() == "TRACKING"


def answered(lockstep, delivery) -> bool:
    wanted = header(delivery.stamp)
    return any(status.header.stamp == wanted.stamp for status in lockstep.camera.got["status"])


def peak_mb(pid: int) -> float:
    return usage(pid).peak_mb


def test_the_process_that_has_ended_is_told():
    with pytest.raises(OSError):
        look(2**22 + 1)
