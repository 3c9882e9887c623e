# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Between ROS, which spins in a thread of its own, and the server's asynchronous loop."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from functools import wraps
from typing import Any, Protocol

from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from het_ros.operator.config import OperatorConfig
from het_ros.operator.discovery import find_trackers
from het_ros.operator.messages import Answer
from het_ros.operator.pictures import Picture
from het_ros.operator.recordings import Recordings
from het_ros.operator.ros_thread import RosThread
from het_ros.operator.settings import LiveSettings
from het_ros.operator.watch import Watch
from het_ros.tracking.box import Box

LATEST = 2**31 * 10**9  # ns: stamps end there
RESTORE = 3.0  # s after a pick, in which the tracker takes the box before it forgets old images


class Viewer(Protocol):
    """Who looks at a tracker: a browser. Both calls come in the loop's thread."""

    def tell(self, message: dict[str, Any]) -> None:
        """Take a message, at once."""

    def show(self, picture: Picture) -> None:
        """Take an image, at once."""


def answered(work: Callable[..., Awaitable[str]]) -> Callable[..., Awaitable[Answer]]:
    """Make an answer of what a request to a tracker returns, or of the reason that it raises."""

    @wraps(work)
    async def answer(bridge: Bridge, tracker: str, *fields: Any, **named: Any) -> Answer:
        try:
            if not await bridge.knows(tracker):
                raise ValueError(f"there is no tracker {tracker}")
            return Answer(True, await work(bridge, tracker, *fields, **named))
        except (OSError, ValueError) as error:
            return Answer(False, str(error))

    return answer


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
        self._keep_until: dict[str, float] = {}
        self._watches: dict[str, Watch] = {}
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
        self._picking.pop(viewer, None)
        self._ros.later(self._match)

    async def knows(self, tracker: str) -> bool:
        """Whether a tracker is there, or was while it is looked at: names come from outside."""
        return await self._ros.do(lambda: tracker in {*self._watches, *find_trackers(self._node)})

    async def freeze(self, viewer: Viewer, tracker: str, on: bool) -> None:
        """Let the tracker keep its images while a viewer draws a box on one of them."""
        self._picking.pop(viewer, None)
        if on and self._config.keep_seconds and tracker in self._watches:
            self._picking[viewer] = tracker
            self._keep_until[tracker] = time.monotonic() + RESTORE
            await self._settings.raise_ring(tracker, self._config.keep_seconds)

    @answered
    async def pick(self, tracker: str, box: list[float], stamp: str, replace: bool) -> str:
        """Start a track on the image of that stamp, ns; a running one is replaced on demand."""
        if int(stamp) >= LATEST:
            raise ValueError("no image has such a stamp")
        if tracker not in self._watches:
            raise ValueError(f"{tracker} is not looked at")
        watch = self._watches[tracker]
        await self._ros.do(lambda: watch.start(Box(*map(float, box)), int(stamp), replace))
        return "the box is sent"

    @answered
    async def reset(self, tracker: str) -> str:
        """Let the tracker forget its target."""
        return await self._ask(Trigger, f"{tracker}/reset", Trigger.Request())

    @answered
    async def enable(self, tracker: str, on: bool) -> str:
        """Let the tracker go on, or pause it."""
        return await self._ask(SetBool, f"{tracker}/enable", SetBool.Request(data=on))

    @answered
    async def record(self, tracker: str, on: bool) -> str:
        """Start or stop the recording of what a tracker publishes."""
        work = self._recordings.start if on else self._recordings.stop
        return await self._ros.do(lambda: work(tracker))

    @answered
    async def set(self, tracker: str, name: str, value: bool | float) -> str:
        """Change one parameter."""
        return await self._settings.write(tracker, name, value)

    async def parameters(self, tracker: str) -> dict[str, Any]:
        """The message with the parameters that can be changed while the tracker runs."""
        found = await self._settings.read(tracker) if await self.knows(tracker) else []
        return {"type": "parameters", "parameters": found}

    async def _ask(self, kind: Any, name: str, request: Any) -> str:
        """What a service says that answers with success and message; ValueError for no success."""
        response = await self._ros.call(kind, name, request)
        if not response.success:
            raise ValueError(response.message)
        return str(response.message)

    # In the node's thread -------------------------------------------------------------------

    def _match(self) -> None:
        """Watch what is looked at, if it is there or was: names come from outside."""
        names = {tracker for tracker in tuple(self._viewers.values()) if tracker}
        wanted = names & {*(find_trackers(self._node) if names else ()), *self._watches}
        for tracker in self._watches.keys() - wanted:
            self._watches.pop(tracker).close()
        for tracker in wanted - self._watches.keys():
            self._watches[tracker] = Watch(
                self._node, tracker, self._teller(tracker, "tell"), self._teller(tracker, "show")
            )
        for watch in self._watches.values():
            watch.find_camera()

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
        """Tell viewers once a second what there is; look for it only while somebody needs it."""
        while True:
            if self._viewers or self._recordings.running or self._keep_until:
                names, recordings, images = await self._ros.do(self._news)
                for viewer, tracker in tuple(self._viewers.items()):
                    viewer.tell(
                        {"type": "trackers", "names": names, "images": images.get(tracker, "")}
                    )
                    if tracker in recordings:
                        viewer.tell(recordings[tracker])
                await self._restore(names)
            await asyncio.sleep(1.0)

    async def _restore(self, names: list[str]) -> None:
        """Let trackers on which nobody draws any more keep as few images as before."""
        now = time.monotonic()
        self._keep_until |= dict.fromkeys(self._picking.values(), now + RESTORE)
        for tracker, until in tuple(self._keep_until.items()):
            if until < now:
                del self._keep_until[tracker]
                await self._settings.restore_ring(tracker, tracker in names)
