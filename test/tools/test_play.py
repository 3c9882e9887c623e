# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import contextlib
import itertools
import threading
import time
from collections import defaultdict

import numpy as np
import pytest

from het_ros import Box, State
from het_ros.ros.status import Status, status_message
from het_ros.tools.bag_messages import INIT_BOX_TOPIC, box_of, stamp_of
from het_ros.tools.bag_reader import BagReader, header_stamp
from het_ros.tools.bag_writer import TYPESTORE, BagWriter
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.play import main, play
from het_ros.tools.player import Player
from het_ros.tools.results import read_csv
from het_ros.tools.tracker_process import free_domain
from het_ros.tools.transport import find_profile, use_profile


class Listener:
    """A node in a thread that keeps every byte it gets and answers each image like a tracker."""

    def __init__(self, bag: BagReader) -> None:
        import rclpy
        from diagnostic_msgs.msg import DiagnosticArray
        from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
        from rclpy.qos import QoSProfile

        from het_ros.tools.message_types import message_class

        use_profile()
        self.heard: dict[str, list[bytes]] = defaultdict(list)
        self.times: list[float] = []
        self._image_topic = bag.image_topic
        self._image_class = message_class(bag.topics[bag.image_topic])
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node("tracker", context=self._context)
        self._status = self._node.create_publisher(DiagnosticArray, "~/status", 100)
        for topic, kind in bag.topics.items():
            self._node.create_subscription(
                message_class(kind),
                topic,
                lambda cdr, topic=topic: self._hear(topic, cdr),
                QoSProfile(depth=1000),
                raw=True,
            )
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)

        def spin() -> None:
            with contextlib.suppress(ExternalShutdownException):
                executor.spin()

        self._thread = threading.Thread(target=spin)
        self._thread.start()

    def _hear(self, topic: str, cdr: bytes) -> None:
        from rclpy.serialization import deserialize_message

        self.heard[topic].append(bytes(cdr))
        if topic == self._image_topic:
            self.times.append(time.monotonic())
            header = deserialize_message(cdr, self._image_class).header
            status = Status(State.IDLE, 0.0, 0.001, 0.0, "")
            self._status.publish(status_message(status, "tracker", header))

    def close(self) -> None:
        self._context.try_shutdown()
        self._thread.join()
        self._node.destroy_node()


@pytest.fixture
def own_domain(monkeypatch, tmp_path):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(free_domain()))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))


@pytest.fixture
def listener(crossing_bag, own_domain):
    with BagReader(crossing_bag) as bag:
        made = Listener(bag)
    yield made
    made.close()


def test_what_is_played_arrives_byte_by_byte(crossing_bag, listener, tmp_path, capsys):
    """Raw bytes on the other side equal the bag's: nothing is lost, nothing is re-encoded."""
    assert main([str(crossing_bag), "--out", str(tmp_path / "out"), "--rate", "2"]) == 0
    assert "40 sent, 40 answered (100.0%)" in capsys.readouterr().out
    with BagReader(crossing_bag) as bag:
        recorded = {topic: [r.cdr for r in bag.recorded(topic)] for topic in bag.topics}
    assert listener.heard == recorded
    rows = read_csv(tmp_path / "out" / "track.csv")
    assert [row.state for row in rows] == [State.IDLE] * 40


class Clock:
    """Stands for the machine's: goes on while a player waits, and where it is told to."""

    def __init__(self, held_up: dict[int, float]) -> None:
        self.now, self.spins, self.held_up = 100.0, 0, held_up

    def monotonic(self) -> float:
        return self.now

    def spin(self, seconds: float) -> None:
        self.spins += 1
        self.now += self.held_up.get(self.spins, 0.0) + seconds


@pytest.mark.parametrize(
    ("held_up", "rate"), [({}, 1.0), ({}, 3.0), ({1: 0.2}, 1.0), ({5: 0.1, 9: 0.3}, 3.0)]
)
def test_frames_come_at_the_rate_that_was_asked_for(
    crossing_bag, graph, monkeypatch, held_up, rate
):
    """None too early, and who was held up catches up by a fifth of a frame's time a frame."""
    from rclpy.node import Node

    clock, sent = Clock(held_up), []
    monkeypatch.setattr("het_ros.tools.player.time", clock)
    node = graph.keep(Node("player", context=graph.context))
    with BagReader(crossing_bag) as bag:
        player = Player(node, bag, "/tracker")
        monkeypatch.setattr(player, "publish", lambda recorded: None)
        for recorded in player.in_real_time(clock.spin, rate, StopRequest()):
            sent.append((clock.now, recorded.time))
    now, recorded = (np.array(column) for column in zip(*sent, strict=True))
    due = (recorded - recorded[0]) * 1e-9 / rate
    late = now - now[0] - due
    assert (late > -1e-9).all()
    assert (np.diff(now) > 0.8 * np.diff(due) - 1e-9).all(), "no bursts"
    assert late.max() <= sum(held_up.values()) + 1e-9
    assert not held_up or late[-1] < late.max() > 0.05, "it catches up"


def test_the_bag_s_own_box_may_be_left_out(crossing_bag, listener, tmp_path):
    with BagReader(crossing_bag) as bag:
        stamps = play(bag, tmp_path / "bag", StopRequest(), rate=5, without_box=True)
    assert len(stamps) == 40
    assert INIT_BOX_TOPIC not in listener.heard


def test_stamps_of_the_play_are_now_and_the_results_have_the_bag_s(
    crossing_bag, listener, tmp_path, capsys
):
    begun = time.time_ns()
    options = ["--out", str(tmp_path / "out"), "--rate", "2", "--now"]
    assert main([str(crossing_bag), *options]) == 0
    assert "40 sent, 40 answered (100.0%)" in capsys.readouterr().out
    with BagReader(crossing_bag) as bag:
        recorded = [header_stamp(r.cdr) for r in bag.recorded(bag.image_topic)]
        heard = [header_stamp(cdr) for cdr in listener.heard[bag.image_topic]]
        rest = [r.cdr[12:] for r in bag.recorded(bag.image_topic)]
        assert [cdr[12:] for cdr in listener.heard[bag.image_topic]] == rest
    assert begun < heard[0] < time.time_ns()
    steps = [b - a for a, b in itertools.pairwise(heard)]
    assert steps == pytest.approx([(b - a) / 2 for a, b in itertools.pairwise(recorded)], abs=2)
    (box,) = listener.heard[INIT_BOX_TOPIC]
    assert header_stamp(box) == heard[0]  # it still names its image
    rows = read_csv(tmp_path / "out" / "track.csv")
    assert [row.stamp for row in rows] == recorded
    assert [row.state for row in rows] == [State.IDLE] * 40


def test_a_box_of_the_command_line_is_sent_with_the_first_stamp(crossing_bag, listener, tmp_path):
    with BagReader(crossing_bag) as bag:
        stamps = play(bag, tmp_path / "bag", StopRequest(), rate=5, init=Box(1, 2, 30, 40))
    kind = "geometry_msgs/msg/PolygonStamped"
    boxes = [TYPESTORE.deserialize_cdr(cdr, kind) for cdr in listener.heard[INIT_BOX_TOPIC]]
    assert [box_of(box) for box in boxes] == [Box(1, 2, 30, 40)]
    assert stamp_of(boxes[0]) == stamps[0]


def test_a_stop_ends_the_play_and_keeps_the_recording(crossing_bag, listener, tmp_path):
    stop = StopRequest()

    def alive() -> None:
        stop.requested = len(listener.times) >= 10

    with BagReader(crossing_bag) as bag:
        stamps = play(bag, tmp_path / "bag", stop, alive=alive)
    assert 10 <= len(stamps) < 40
    with BagReader(tmp_path / "bag") as recording:
        assert recording.counts["/tracker/status"] >= 9


def test_nobody_there_is_told_with_what_to_do(crossing_bag, own_domain, tmp_path, capsys):
    options = [str(crossing_bag), "--out", str(tmp_path / "out"), "--wait", "0.2"]
    assert main(options) == 1
    told = capsys.readouterr().err
    assert "nobody subscribed to /image/compressed and /tracker/init_box" in told
    assert "start the tracker first" in told
    assert "image_transport:=compressed" in told
    assert "ROS_DOMAIN_ID" in told


def test_a_type_that_is_not_jazzys_is_refused(crossing_bag, own_domain, tmp_path, capsys):
    """A publisher takes any bytes, so a wrong type has to be found before."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    definition = "std_msgs/Header header\nuint8[] data\n"
    header, _ = TYPESTORE.generate_msgdef("std_msgs/msg/Header", ros_version=2)
    text = f"{definition}{'=' * 80}\nMSG: std_msgs/Header\n{header}"
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(text, "sensor_msgs/msg/CompressedImage"))
    with Writer(tmp_path / "odd", version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        topic = bag.add_connection(
            "/image/compressed", "sensor_msgs/msg/CompressedImage", typestore=store
        )
        bag.write(topic, 0, b"\x00\x01\x00\x00" + bytes(16))
    assert main([str(tmp_path / "odd"), "--out", str(tmp_path / "out"), "--wait", "0.2"]) == 1
    assert "not ROS 2 Jazzy's" in capsys.readouterr().err


def test_an_empty_bag_is_refused(own_domain, tmp_path, capsys):
    with BagWriter(tmp_path / "empty"):
        pass
    assert main([str(tmp_path / "empty"), "--out", str(tmp_path / "out")]) == 1
    assert "no images to play; it holds nothing" in capsys.readouterr().err


@pytest.mark.parametrize("rate", ["0", "-1", "nan", "inf"])
def test_a_rate_that_makes_no_sense_is_refused(crossing_bag, tmp_path, capsys, rate):
    assert main([str(crossing_bag), "--out", str(tmp_path), f"--rate={rate}"]) == 1
    assert "rate" in capsys.readouterr().err


def test_the_shipped_profile_is_found_and_the_users_own_respected(monkeypatch):
    import os

    for name in ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"):
        monkeypatch.delenv(name, raising=False)
    use_profile()
    assert os.environ["FASTRTPS_DEFAULT_PROFILES_FILE"] == str(find_profile())
    assert "SHM" in find_profile().read_text()
    monkeypatch.setenv("FASTRTPS_DEFAULT_PROFILES_FILE", "mine.xml")
    use_profile()
    assert os.environ["FASTRTPS_DEFAULT_PROFILES_FILE"] == "mine.xml"
