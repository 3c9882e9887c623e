# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The operator's server on a recorded stream, without a ROS graph: the shipped bag."""

from __future__ import annotations

import asyncio
import threading
import time
from functools import cache
from pathlib import Path

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import CompressedImage

from het_ros import Box
from het_ros.operator.config import OperatorConfig
from het_ros.operator.messages import Answer
from het_ros.operator.pictures import Picture
from het_ros.operator.server import Server
from het_ros.ros.messages import header_of
from het_ros.tools.bag_reader import BagReader

BAG = Path(__file__).parents[2] / "bags" / "follow_walk"
REASONS = {"LOST": "not seen for 2.1 s", "COASTING": "not seen for 0.4 s", "IDLE": "no box yet"}
PARAMETERS = [
    {"name": "lost_after", "value": 2.0, "help": "time until LOST [s]", "low": 0.0, "high": 60.0,
     "whole": False},
    {"name": "rotation", "value": True, "help": "follow turns", "low": None, "high": None,
     "whole": False},
]  # fmt: skip


@cache
def recorded() -> tuple[list[Box], list[bytes]]:
    """True boxes and serialized images of the bag; read once for all servers."""
    with BagReader(BAG) as bag:
        return list(bag.truth().values()), [r.cdr for r in bag.recorded(bag.image_topic)]


class RecordedBridge:
    """A bridge whose tracker knows the truth, and which keeps what it was asked for.

    Attributes:
        asked: what viewers asked for, in order.
        shown: number of the bag's frame by the stamp it was shown with, ns.
        state: what the tracker says; set it to LOST to lose the target.
        viewers: who looks.
        refusal: what a pick is refused with; empty takes it.
    """

    def __init__(self, rate: float = 15.0) -> None:
        self._truth, self._frames = recorded()
        self.asked: list[tuple] = []
        self.shown: dict[int, int] = {}
        self.state, self.refusal = "IDLE", ""
        self.names = ["/left/tracker", "/tracker"]
        self.viewers: dict = {}
        self._step = 1 / rate
        self._playing = asyncio.ensure_future(self._play())

    async def close(self) -> None:
        self._playing.cancel()

    def truth(self, stamp: int) -> Box:
        return self._truth[self.shown[stamp]]

    def look(self, viewer, tracker) -> None:
        self.viewers[viewer] = tracker
        viewer.tell({"type": "trackers", "names": self.names, "images": "/image/compressed"})

    def leave(self, viewer) -> None:
        self.viewers.pop(viewer, None)

    async def freeze(self, viewer, tracker, on) -> None:
        self.asked.append(("freeze", on))

    async def pick(self, tracker, box, stamp, replace) -> Answer:
        self.asked.append(("pick", tracker, Box(*box), int(stamp), replace))
        if self.state == "TRACKING" and not replace:
            return Answer(False, "a track is running: replace it?")
        if self.refusal:
            self._tell({"type": "log", "warning": True, "text": self.refusal})
        else:
            self.state = "TRACKING"
        return Answer(True, "the box is sent")

    async def reset(self, tracker) -> Answer:
        self.asked.append(("reset",))
        self.state = "IDLE"
        return Answer(True, "was TRACKING, now IDLE")

    async def enable(self, tracker, on) -> Answer:
        self.asked.append(("enable", on))
        return Answer(True, "images are processed" if on else "images are ignored")

    async def record(self, tracker, on) -> Answer:
        self.asked.append(("record", on))
        self._tell({"type": "recording", "on": on, "path": "/tmp/bag", "bytes": 1500000})
        return Answer(True, "recording")

    async def parameters(self, tracker) -> dict:
        return {"type": "parameters", "parameters": PARAMETERS}

    async def set(self, tracker, name, value) -> Answer:
        self.asked.append(("set", name, value))
        return Answer(True, f"{name} is {value}")

    def _tell(self, message) -> None:
        for viewer, tracker in tuple(self.viewers.items()):
            if tracker:
                viewer.tell(message)

    async def _play(self) -> None:
        count, number = len(self._frames), 0
        while True:
            place = number % (2 * count - 2)
            place = min(place, 2 * count - 2 - place)  # to and fro
            number += 1
            self._send(place, number)
            await asyncio.sleep(self._step)

    def _send(self, place: int, number: int) -> None:
        stamp = time.time_ns()
        self.shown[stamp] = place
        message = deserialize_message(self._frames[place], CompressedImage)
        message.header = header_of(stamp)
        picture = Picture(message, number)
        for viewer, tracker in tuple(self.viewers.items()):
            if tracker:
                viewer.show(picture)
        box, ahead = self._truth[place], self._truth[min(place + 3, len(self._truth) - 1)]
        seen = self.state in ("TRACKING", "COASTING")
        velocity = [(b - a) * 5 for a, b in zip(box.centre, ahead.centre, strict=True)]
        self._tell(
            {
                "type": "track",
                "stamp": str(stamp),
                "state": self.state,
                "score": 0.9 - 0.2 * (place % 10) / 10 if seen else 0.0,
                "latency_ms": 8.0,
                "age_s": 0.0,
                "reason": ""
                if seen
                else "not seen for 2.1 s"
                if self.state == "LOST"
                else "reset",
                "box": [box.x, box.y, box.w, box.h] if seen else None,
                "velocity": velocity if seen else None,
            }
        )


class RunningServer:
    """A server in a thread of its own; ``kill`` and ``start`` are for who wants to see it fail.

    Args:
        token: of the server.
        **config: settings.
    """

    def __init__(self, token: str = "", **config) -> None:
        self.token = token
        self.config = OperatorConfig(**{"port": 0, **config})
        self.loop = asyncio.new_event_loop()
        self.faults: list[dict] = []
        self.loop.set_exception_handler(lambda _, context: self.faults.append(context))
        self._thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self._thread.start()
        self.bridge = self.do(self._make_bridge())
        self.start()

    async def _make_bridge(self) -> RecordedBridge:
        return RecordedBridge()

    def do(self, work):
        """The result of a coroutine, run in the server's loop."""
        return asyncio.run_coroutine_threadsafe(work, self.loop).result(60)

    def start(self) -> None:
        async def start() -> Server:
            server = Server(self.bridge, self.config, self.token)
            await server.start()
            return server

        self.server = self.do(start())
        self.config = OperatorConfig(**{**vars(self.config), "port": self.server.port})

    def kill(self) -> None:
        """Stop listening; ``start`` takes the same port again."""
        self.do(self.server.close())

    def close(self) -> None:
        self.do(self.bridge.close())
        self.do(self.server.close())
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join(10)

    @property
    def url(self) -> str:
        return f"http://localhost:{self.server.port}/"
