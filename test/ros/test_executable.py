# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The installed executable in a process of its own, over DDS, as ``ros2 run`` starts it."""

import signal
import time

import pytest

from het_ros import Box
from het_ros.ros.messages import box_from_polygon
from het_ros.ros.status import status_values

from .streams import FRAME_TIME, Camera, box_message, header_at, image_message


def qos(topic: str, override: str) -> tuple[str, ...]:
    return "--ros-args", "-p", f"qos_overrides./{topic}.subscription.{override}"


def test_follows_what_another_process_sends(processes, local_graph, made_footage):
    frames, box = made_footage
    remap, patient = ("-r", "image:=/camera/image_raw"), ("-p", "image_timeout:=0.0")
    tracker = processes("tracker", "--ros-args", *remap, *patient)
    camera = local_graph.add(
        Camera(
            context=local_graph.context, cli_args=["--ros-args", "-r", "image:=/camera/image_raw"]
        )
    )
    camera.meet(local_graph)
    camera.show(local_graph, image_message(frames[0], header_at(1.0)))
    camera.boxes.publish(box_message(box, header_at(1.0)))
    local_graph.spin_until(lambda: camera.got["box"], "the first box")
    for i, frame in enumerate(frames[1:20], 1):
        camera.show(local_graph, image_message(frame, header_at(1 + i * FRAME_TIME)))
    local_graph.spin_until(lambda: len(camera.got["box"]) == 20, "a box a frame")

    states = [status_values(status)["state"] for status in camera.got["status"]]
    assert states == ["IDLE"] + ["TRACKING"] * 20
    assert box_from_polygon(camera.got["box"][-1]).iou(Box(58, 49, 20, 32)) > 0.6
    assert camera.got["box"][-1].header == header_at(1 + 19 * FRAME_TIME)
    assert tracker.poll() is None


@pytest.mark.parametrize("pause", [0.0, 0.01, 0.05, 0.2])
def test_a_second_ctrl_c_is_no_other_than_the_first(processes, local_graph, pause):
    """Under launch a terminal's Ctrl-C reaches a node twice: from the terminal and from launch."""
    tracker = processes("tracker")
    camera = local_graph.add(Camera(context=local_graph.context))
    local_graph.spin_until(camera.connected, "discovery")
    for _ in range(3):
        tracker.send_signal(signal.SIGINT)
        time.sleep(pause)
    assert tracker.wait() == 0
    assert "Traceback" not in tracker.log.read_text()


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_cleanly(processes, local_graph, stop):
    tracker = processes("tracker")
    camera = local_graph.add(Camera(context=local_graph.context))
    local_graph.spin_until(camera.connected, "discovery")
    tracker.send_signal(stop)
    assert tracker.wait() == 0
    assert "Traceback" not in tracker.log.read_text()


@pytest.mark.parametrize(
    "arguments, says",
    [
        (("--ros-args", "-p", "max_gap:=-1.0"), "max_gap"),
        (("--ros-args", "-p", "seed:=much"), "seed"),
        (("--ros-args", "-p", "image_transport:=smoke"), "raw, compressed"),
        (("--fast",), "--fast"),
        (qos("image", "reliability:=foo"), "auto, reliable, best_effort, not 'foo'"),
        (qos("image", "depth:=-1"), "qos_overrides./image.subscription"),
        (qos("camera_info", "reliability:=foo"), "best_effort, reliable"),
        (("--ros-args", "-p", "garbage"), "garbage"),
        (("--ros-args", "--params-file", "missing.yaml"), "missing.yaml"),
        (("--targets", "a,a"), "names a twice"),
        (("--targets", "a,b", "--ros-args", "-r", "__node:=x"), "__node:=x"),
    ],
)
def test_wrong_arguments_end_it_with_a_reason(processes, arguments, says):
    tracker = processes("tracker", *arguments)
    assert tracker.wait() == 2
    lines = tracker.log.read_text().splitlines()
    assert says in lines[-1]
    assert lines[-1].startswith("tracker: ") and (len(lines) == 1 or "usage" in lines[0])


def test_help_has_an_example(processes):
    tracker = processes("tracker", "--help")
    assert tracker.wait() == 0
    assert "example: ros2 run het_ros tracker" in tracker.log.read_text()
