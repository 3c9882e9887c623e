# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Between ROS, which spins in a thread of its own, and the server's asynchronous loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Protocol

from geometry_msgs.msg import PolygonStamped
from rcl_interfaces.msg import Log
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from het_ros.operator.config import OperatorConfig
from het_ros.operator.discovery import find_trackers
from het_ros.operator.messages import Answer
from het_ros.operator.pictures import Picture
from het_ros.operator.recordings import Recordings
from het_ros.operator.ros_thread import RosThread
from het_ros.operator.settings import LiveSettings
from het_ros.operator.watch import RELIABLE, WITH_BOX, Watch
from het_ros.ros.messages import header_of, polygon_from_box
from het_ros.tracking.box import Box

WARN = 30  # level of rcl_interfaces/Log
LONGEST_LINE = 1000  # letters
LATEST = 2**31 * 10**9  # ns: stamps end there
RESTORE = 3.0  # s after a pick, in which the tracker takes the box before it forgets old images


class Viewer(Protocol):
    """Who looks at a tracker: a browser. Both calls come in the loop's thread."""

    def tell(self, message: dict[str, Any]) -> None:
        """Take a message, at once."""

    def show(self, picture: Picture) -> None:
        """Take an image, at once."""


class Bridge:
    """Serves viewers from one ROS node; everything public is called in the loop's thread.

    Subscriptions are there while somebody looks. In the node's thread one callback runs at a
    time, so what belongs to ROS needs no lock.

    Args:
        node: subscribes, publishes and calls; nobody else spins it.
        config: the operator's settings.
    """

    def __init__(self, node: Node, config: OperatorConfig) -> None:
        self._node = node
        self._config = config
        self._viewers: dict[Viewer, str] = {}
        self._picking: dict[Viewer, str] = {}
        self._restoring: set[asyncio.Future[None]] = set()
        self._watches: dict[str, Watch] = {}
        self._publishers: dict[str, Any] = {}
        self._log: Any = None
        self._recordings = Recordings(node, config)
        self._ros = RosThread(node)
        self._settings = LiveSettings(self._ros)
        self._ticking = asyncio.ensure_future(self._tick())

    async def close(self) -> None:
        """End recordings and subscriptions, and stop spinning."""
        self._ticking.cancel()
        self._viewers.clear()
        await self._ros.do(self._recordings.stop_all)
        await self._ros.do(self._match)
        await self._ros.close()

    def look(self, viewer: Viewer, tracker: str) -> None:
        """Show a tracker to a viewer; an empty name shows the list of trackers only."""
        self._viewers[viewer] = tracker
        self._ros.later(self._match)

    def leave(self, viewer: Viewer) -> None:
        """Show a viewer nothing more."""
        self._viewers.pop(viewer, None)
        self._stop_picking(viewer)
        self._ros.later(self._match)

    async def freeze(self, viewer: Viewer, tracker: str, on: bool) -> None:
        """Let the tracker keep its images while a viewer draws a box on one of them."""
        if not on:
            self._stop_picking(viewer)
        elif self._config.keep_seconds and tracker in self._watches:
            first = tracker not in self._picking.values()
            self._picking[viewer] = tracker
            if first:
                await self._settings.raise_ring(tracker, self._config.keep_seconds)

    async def pick(self, tracker: str, box: list[float], stamp: str, replace: bool) -> Answer:
        """Start a track on the image of that stamp, ns; a running one is replaced on demand."""

        def publish() -> Answer:
            watch, publisher = self._watches.get(tracker), self._publishers.get(tracker)
            if watch is None or publisher is None or not publisher.get_subscription_count():
                return Answer(False, f"{tracker or 'no tracker'} takes no boxes now")
            if watch.tracks.state in WITH_BOX and not replace:
                return Answer(False, "a track is running: replace it?")
            publisher.publish(polygon_from_box(Box(*map(float, box)), header_of(int(stamp))))
            return Answer(True, "the box is sent")

        if int(stamp) >= LATEST:
            return Answer(False, "no image has such a stamp")
        return await self._ros.do(publish)

    async def reset(self, tracker: str) -> Answer:
        """Let the tracker forget its target."""
        return await self._ask(Trigger, tracker, "reset", Trigger.Request())

    async def enable(self, tracker: str, on: bool) -> Answer:
        """Let the tracker go on, or pause it."""
        return await self._ask(SetBool, tracker, "enable", SetBool.Request(data=on))

    async def record(self, tracker: str, on: bool) -> Answer:
        """Start or stop the recording of what a tracker publishes."""
        if on and not await self._is_there(tracker):
            return Answer(False, f"there is no tracker {tracker}")
        recordings = self._recordings
        work = recordings.start if on else recordings.stop
        return await self._ros.do(lambda: work(tracker))

    async def parameters(self, tracker: str) -> dict[str, Any]:
        """The message with the parameters that can be changed while the tracker runs."""
        there = await self._is_there(tracker)
        found = await self._settings.read(tracker) if there else []
        return {"type": "parameters", "parameters": found}

    async def set(self, tracker: str, name: str, value: bool | float) -> Answer:
        """Change one parameter."""
        if not await self._is_there(tracker):
            return Answer(False, f"there is no tracker {tracker}")
        return await self._settings.write(tracker, name, value)

    # In the node's thread -------------------------------------------------------------------

    def _match(self) -> None:
        """Watch what is looked at, if it is there or was: names come from outside."""
        names = {tracker for tracker in tuple(self._viewers.values()) if tracker}
        wanted = names & {*(find_trackers(self._node) if names else ()), *self._watches}
        for tracker in self._watches.keys() - wanted:
            self._watches.pop(tracker).close()
            self._node.destroy_publisher(self._publishers.pop(tracker))
        for tracker in wanted - self._watches.keys():
            self._watches[tracker] = Watch(
                self._node, tracker, self._teller(tracker, "tell"), self._teller(tracker, "show")
            )
            self._publishers[tracker] = self._node.create_publisher(
                PolygonStamped, f"{tracker}/init_box", RELIABLE
            )
        for watch in self._watches.values():
            watch.find_camera()
        if wanted and self._log is None:
            self._log = self._node.create_subscription(Log, "/rosout", self._on_log, 100)
        elif not wanted and self._log is not None:
            self._node.destroy_subscription(self._log)
            self._log = None

    def _on_log(self, message: Log) -> None:
        """What a tracker says, a refusal for example, as it is written."""
        for tracker in self._watches:
            if message.name == tracker.strip("/").replace("/", "."):
                told = {
                    "type": "log",
                    "warning": message.level >= WARN,
                    "text": message.msg[:1000],
                }
                self._teller(tracker, "tell")(told)

    def _teller(self, tracker: str, what: str) -> Callable[[Any], None]:
        """A function that hands things from the node's thread to a tracker's viewers."""

        def hand_over(thing: Any) -> None:
            for viewer, looks_at in tuple(self._viewers.items()):
                if looks_at == tracker:
                    getattr(viewer, what)(thing)

        return lambda thing: self._ros.in_loop(hand_over, thing)

    def _news(self) -> tuple[list[str], dict[str, dict[str, Any]], dict[str, str]]:
        """Names of the trackers, their recordings, and the topics of the watched ones' images."""
        names = find_trackers(self._node)
        self._match()
        recordings = {name: self._recordings.state(name) for name in {*names, *self._watches}}
        return names, recordings, {name: w.images[0] for name, w in self._watches.items()}

    # In the loop's thread -------------------------------------------------------------------

    async def _tick(self) -> None:
        """Tell viewers once a second what there is; look for it only while there are any."""
        while True:
            if self._viewers or self._recordings.running:
                names, recordings, images = await self._ros.do(self._news)
                for viewer, tracker in tuple(self._viewers.items()):
                    viewer.tell(
                        {"type": "trackers", "names": names, "images": images.get(tracker, "")}
                    )
                    if tracker in recordings:
                        viewer.tell(recordings[tracker])
            await asyncio.sleep(1.0)

    def _stop_picking(self, viewer: Viewer) -> None:
        tracker = self._picking.pop(viewer, None)
        if tracker is not None and tracker not in self._picking.values():
            task = asyncio.ensure_future(self._restore(tracker))
            self._restoring.add(task)
            task.add_done_callback(self._restoring.discard)

    async def _restore(self, tracker: str) -> None:
        """Let the tracker keep as few images as before, unless somebody picks again."""
        await asyncio.sleep(RESTORE)
        if tracker not in self._picking.values():
            await self._settings.restore_ring(tracker)

    async def _is_there(self, tracker: str) -> bool:
        return tracker in await self._ros.do(lambda: find_trackers(self._node))

    async def _ask(self, kind: Any, tracker: str, verb: str, request: Any) -> Answer:
        """Call a tracker's service that answers with success and message."""
        if not await self._is_there(tracker):
            return Answer(False, f"there is no tracker {tracker}")
        try:
            response = await self._ros.call(kind, f"{tracker}/{verb}", request)
        except TimeoutError as error:
            return Answer(False, str(error))
        return Answer(response.success, response.message)
