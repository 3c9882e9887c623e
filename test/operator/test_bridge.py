# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The bridge on a tracker node of this process."""

from __future__ import annotations

import asyncio
import time

import pytest
from geometry_msgs.msg import PolygonStamped
from moving_target import FIRST_BOX
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import Image

from het_ros.operator.bridge import Bridge
from het_ros.operator.config import OperatorConfig
from het_ros.operator.messages import Answer
from het_ros.operator.ros_thread import RosThread
from het_ros.ros.messages import header_of
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tools.bag_reader import BagReader

PATIENCE = 60  # s: how long something that must happen may take on a busy machine
STEP = 33_000_000  # ns


class Viewer:
    """Keeps what it is given."""

    def __init__(self) -> None:
        self.messages: list[dict] = []
        self.pictures: list = []

    def tell(self, message) -> None:
        self.messages.append(message)

    def show(self, picture) -> None:
        self.pictures.append(picture)

    def newest(self, kind: str) -> dict:
        return next((m for m in reversed(self.messages) if m["type"] == kind), {})

    @property
    def state(self) -> str:
        return self.newest("track").get("state", "")

    def said(self, text: str) -> bool:
        return any(text in m["text"] for m in self.messages if m["type"] == "log")


class World:
    """A tracker, a camera and a bridge, each node in a thread of its own."""

    def __init__(self, graph, config: OperatorConfig, frames, names=("tracker",)) -> None:
        self.trackers = []
        for name in names:
            space, _, own = name.rpartition("/")
            node = TrackerNode(
                own,
                namespace=space or None,
                context=graph.context,
                parameter_overrides=[Parameter("max_gap", value=3600.0)],  # a busy machine's
            )
            self.trackers.append(RosThread(node))
        self.node = Node("operator", context=graph.context)
        self.camera = Node("camera", context=graph.context)
        self.images = self.camera.create_publisher(Image, "image", 1)
        self.bridge = Bridge(self.node, config)
        self.frames, self.sent = frames, 0
        self.start = time.time_ns()

    async def close(self) -> None:
        await self.bridge.close()
        for tracker in self.trackers:
            await tracker.close()
            tracker.node.destroy_node()
        self.node.destroy_node()
        self.camera.destroy_node()

    def place(self, number: int) -> int:
        """Which frame the image of that number is: they are played to and fro."""
        turn = 2 * len(self.frames) - 2
        return min(number % turn, turn - number % turn)

    def send(self) -> int:
        """Publish the next image; its stamp, ns."""
        pixels = self.frames[self.place(self.sent)]
        stamp = self.start + self.sent * STEP
        height, width = pixels.shape[:2]
        message = Image(header=header_of(stamp, "camera"), height=height, width=width)
        message.encoding, message.step, message.data = "bgr8", 3 * width, pixels.tobytes()
        self.images.publish(message)
        self.sent += 1
        return stamp

    async def until(self, happened, what: str, images: bool = True):
        """Play images until something happens."""
        end = time.monotonic() + PATIENCE
        while not (result := happened()):
            assert time.monotonic() < end, f"did not happen: {what}"
            if images:
                self.send()
            await asyncio.sleep(0.03)
        return result


@pytest.fixture
def in_world(graph, made_footage, tmp_path):
    """Run ``story(world)`` with settings: ``in_world(story, names=["tracker"], **settings)``."""

    def run(story, names=("tracker",), **settings):
        async def told():
            config = OperatorConfig(**{"recordings": str(tmp_path / "recordings"), **settings})
            world = World(graph, config, made_footage[0], names)
            try:
                await story(world)
            finally:
                await world.close()

        asyncio.run(told())

    return run


async def looking(world: World, tracker: str = "/tracker") -> Viewer:
    """A viewer that sees pictures."""
    viewer = Viewer()
    world.bridge.look(viewer, tracker)
    await world.until(lambda: viewer.pictures and viewer.state, "pictures and states")
    return viewer


def test_a_pick_is_followed_reset_and_refused_in_the_tracker_s_words(in_world):
    async def story(world):
        viewer = await looking(world)
        assert viewer.newest("track")["state"] == "IDLE"
        bridge = world.bridge
        stamp = viewer.pictures[-1].stamp
        place = world.place((stamp - world.start) // STEP)
        box = [FIRST_BOX[0] + 2 * place, FIRST_BOX[1] + place / 2, *FIRST_BOX[2:]]
        assert (await bridge.pick("/tracker", box, str(stamp), False)).ok
        await world.until(lambda: viewer.state == "TRACKING", "a track")
        track = viewer.newest("track")
        assert len(track["box"]) == 4
        assert len(track["velocity"]) == 2
        again = await bridge.pick("/tracker", box, str(stamp), False)
        assert again == Answer(False, "a track is running: replace it?")
        assert (await bridge.pick("/tracker", [0, 0, 0.5, 50], str(stamp), True)).ok
        await world.until(lambda: viewer.said("init box refused"), "the refusal")
        assert (await bridge.reset("/tracker")).ok
        await world.until(lambda: viewer.state == "IDLE", "no track")
        assert (await bridge.enable("/tracker", False)).text == "images are ignored"

    in_world(story)


def test_the_last_viewer_s_leave_closes_the_subscriptions(in_world):
    async def story(world):
        def subscriptions():
            return {s.topic_name for s in world.node.subscriptions}

        before = subscriptions()
        first, second = await looking(world), await looking(world)
        wanted = {"/image", "/tracker/status", "/tracker/box", "/tracker/velocity", "/rosout"}
        assert subscriptions() - before == wanted
        world.bridge.leave(first)
        count = len(second.pictures)
        await world.until(lambda: len(second.pictures) > count + 2, "more for the second")
        world.bridge.leave(second)
        await world.until(lambda: subscriptions() == before, "no subscriptions")

    in_world(story)


def test_several_trackers_are_found_and_what_is_none_is_left_alone(in_world):
    async def story(world):
        viewer = Viewer()
        world.bridge.look(viewer, "no/such name\n")
        names = ["/left/tracker", "/right/tracker"]
        await world.until(lambda: viewer.newest("trackers").get("names") == names, "both")
        for answer in (
            await world.bridge.reset("no/such name\n"),
            await world.bridge.set("", "seed", 1),
            await world.bridge.record("/camera", True),
            await world.bridge.pick("/camera", [1, 2, 30, 40], "0", True),
        ):
            assert not answer.ok
        world.bridge.look(viewer, names[1])
        await world.until(
            lambda: viewer.newest("trackers").get("images") == "/right/image", "its images"
        )

    in_world(story, names=("left/tracker", "right/tracker"))


def test_parameters_with_their_ranges_are_read_and_set(in_world):
    async def story(world):
        await looking(world)
        bridge = world.bridge
        found = {p["name"]: p for p in (await bridge.parameters("/tracker"))["parameters"]}
        assert (found["max_gap"]["low"], found["max_gap"]["high"]) == (0.02, 3600.0)
        assert "gap" in found["max_gap"]["help"]
        assert found["seed"]["whole"]
        assert (await bridge.set("/tracker", "max_gap", 3)).ok
        node = world.trackers[0].node
        assert node.get_parameter("max_gap").value == 3.0
        for name, value, says in (
            ("max_gap", 1e9, "max_gap"),
            ("seed", 0.5, "type"),
            ("seed", True, "type"),
            ("image_transport", 1, "not changed"),
            ("use_sim_time", True, "not changed"),
        ):
            answer = await bridge.set("/tracker", name, value)
            assert not answer.ok
            assert says in answer.text
        assert node.get_parameter("max_gap").value == 3.0

    in_world(story)


def test_images_are_kept_while_somebody_picks(in_world, monkeypatch):
    monkeypatch.setattr("het_ros.operator.bridge.RESTORE", 0.1)

    async def story(world):
        first, second = await looking(world), await looking(world)
        node, bridge = world.trackers[0].node, world.bridge

        def kept():
            return node.get_parameter("ring_seconds").value

        await bridge.freeze(first, "/tracker", True)
        assert kept() == 12.0
        await bridge.freeze(second, "/tracker", True)
        await bridge.freeze(first, "/tracker", False)
        await asyncio.sleep(0.5)
        assert kept() == 12.0
        bridge.leave(second)
        await world.until(lambda: kept() == 1.0, "as before")

    in_world(story, keep_seconds=12.0)


def test_a_recording_is_a_bag_of_the_outputs(in_world, tmp_path):
    async def story(world):
        viewer = await looking(world)
        assert (await world.bridge.record("/tracker", True)).ok
        assert not (await world.bridge.record("/tracker", True)).ok
        await world.until(lambda: viewer.newest("recording").get("on"), "the news of it")
        await world.until(lambda: world.sent > 20, "some images")
        answer = await world.bridge.record("/tracker", False)
        assert answer.ok
        assert not (await world.bridge.record("/tracker", False)).ok
        (path,) = (tmp_path / "recordings").iterdir()
        assert str(path) in answer.text
        with BagReader(path) as bag:
            assert bag.counts["/tracker/status"] > 0

    in_world(story)


def test_a_recording_that_grows_too_large_ends_by_itself(in_world, tmp_path, monkeypatch):
    async def story(world):
        viewer = await looking(world)
        world.bridge._recordings._most = 1
        assert (await world.bridge.record("/tracker", True)).ok
        world.bridge.leave(viewer)
        await world.until(lambda: not world.bridge._recordings.running, "its end")

    in_world(story)


def test_pick_asks_for_the_stamp_of_the_image(in_world):
    """What is published is the box as it was drawn, with the stamp of the frozen image."""

    async def story(world):
        got: list[PolygonStamped] = []
        thread = world.trackers[0]
        await thread.do(
            lambda: thread.node.create_subscription(
                PolygonStamped, "/tracker/init_box", got.append, 10
            )
        )
        viewer = await looking(world)
        stamp = viewer.pictures[-1].stamp
        await world.bridge.pick("/tracker", [10.5, 20, 30, 40.25], str(stamp), False)
        (message,) = await world.until(lambda: got, "the box", images=False)
        assert message.header == header_of(stamp)
        assert [(p.x, p.y) for p in message.polygon.points][::2] == [(10.5, 20), (40.5, 60.25)]
        too_late = await world.bridge.pick("/tracker", [1, 1, 9, 9], "9" * 19, False)
        assert not too_late.ok

    in_world(story)
