# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One browser: what it asks for, within bounds, and what it is sent, at its own pace."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from contextlib import suppress
from typing import Any, Protocol

from aiohttp import WSCloseCode, WSMsgType, web

from het_ros.operator.bridge import Viewer
from het_ros.operator.messages import Answer, MessageError, parse
from het_ros.operator.pictures import Picture
from het_ros.ros.images import ImageError

MOST_TEXTS = 300  # that wait for a slow browser; the oldest go first
ON_THE_WAY = 2  # images that a browser has not shown yet
BURST, A_SECOND = 200, 100  # messages of one browser
COMMAND = 10  # a command counts as so many messages
CHEAP = ("shown", "ping")
MOST_FAULTS = 20


class Bridge(Protocol):
    """What a browser can ask for; :class:`het_ros.operator.bridge.Bridge` says what it does."""

    def look(self, viewer: Viewer, tracker: str) -> None: ...  # noqa: D102
    def leave(self, viewer: Viewer) -> None: ...  # noqa: D102
    async def freeze(self, viewer: Viewer, tracker: str, on: bool) -> None: ...  # noqa: D102
    async def pick(self, tracker: str, box: list[float], stamp: int, replace: bool) -> Answer: ...
    async def reset(self, tracker: str) -> Answer: ...  # noqa: D102
    async def enable(self, tracker: str, on: bool) -> Answer: ...  # noqa: D102
    async def record(self, tracker: str, on: bool) -> Answer: ...  # noqa: D102
    async def parameters(self, tracker: str) -> dict[str, Any]: ...  # noqa: D102
    async def set(self, tracker: str, name: str, value: Any) -> Answer: ...  # noqa: D102


class Allowance:
    """Messages that may still come: a bucket that fills with time."""

    def __init__(self) -> None:
        self._left, self._at = float(BURST), time.monotonic()

    def take(self, cost: float) -> bool:
        """Whether so much is allowed now; it is then used up."""
        now = time.monotonic()
        self._left = min(self._left + A_SECOND * (now - self._at), BURST)
        self._at = now
        if self._left < cost:
            return False
        self._left -= cost
        return True


class Client:
    """A connected browser, a viewer of the bridge."""

    def __init__(self, socket: web.WebSocketResponse, bridge: Bridge) -> None:
        self._socket = socket
        self._bridge = bridge
        self._tracker = ""
        self._width, self._quality = 640, 70
        self._texts: deque[str] = deque(maxlen=MOST_TEXTS)
        self._picture: Picture | None = None
        self._on_the_way = 0
        self._news = asyncio.Event()
        self._allowance = Allowance()
        self._faults = 0

    def tell(self, message: dict[str, Any]) -> None:
        """Send a message, after those that wait."""
        self._texts.append(json.dumps(message))
        self._news.set()

    def show(self, picture: Picture) -> None:
        """Send an image, unless a newer one comes before this browser can take it."""
        self._picture = picture
        self._news.set()

    async def serve(self) -> None:
        """Talk with the browser until it goes."""
        self._bridge.look(self, "")
        sending = asyncio.ensure_future(self._send())
        try:
            async for message in self._socket:
                if message.type is not WSMsgType.TEXT or not await self._on_text(message.data):
                    break
        finally:
            self._bridge.leave(self)
            sending.cancel()
            with suppress(asyncio.CancelledError, OSError, RuntimeError):
                await sending
            with suppress(OSError, RuntimeError):
                await self._socket.close(code=WSCloseCode.POLICY_VIOLATION)

    async def _send(self) -> None:
        """Texts first, then the newest image; waits where the browser is slow."""
        while True:
            await self._news.wait()
            self._news.clear()
            while self._texts:
                await self._socket.send_str(self._texts.popleft())
            picture = self._picture
            if picture is None or self._on_the_way >= ON_THE_WAY:
                continue
            self._picture = None
            with suppress(ImageError):
                data = await asyncio.to_thread(picture.encoded, self._width, self._quality)
                self._on_the_way += 1
                await self._socket.send_bytes(data)
            self._news.set()

    async def _on_text(self, text: str) -> bool:
        """Do what a message asks for; False where this browser is to be thrown out."""
        try:
            message = parse(text)
        except MessageError as error:
            self._faults += 1
            self.tell(Answer(False, str(error)).message("unknown"))
            return self._faults < MOST_FAULTS and self._allowance.take(COMMAND)
        kind = message.pop("type")
        if not self._allowance.take(1 if kind in CHEAP else COMMAND):
            return False
        answer = await getattr(self, f"_do_{kind}")(**message)
        if answer is not None:
            self.tell(answer.message(kind))
        return True

    async def _do_view(self, tracker: str, width: int, quality: int) -> None:
        self._width, self._quality = width, quality
        if tracker != self._tracker:
            self._tracker, self._picture, self._on_the_way = tracker, None, 0
            self._bridge.look(self, tracker)
            if tracker:
                self.tell(await self._bridge.parameters(tracker))

    async def _do_shown(self) -> None:
        self._on_the_way = max(self._on_the_way - 1, 0)
        self._news.set()

    async def _do_ping(self, time: float) -> None:
        self.tell({"type": "pong", "time": time, "now": _now()})

    async def _do_freeze(self, on: bool) -> None:
        await self._bridge.freeze(self, self._tracker, on)

    async def _do_pick(self, box: list[float], stamp: str, replace: bool) -> Answer:
        return await self._bridge.pick(self._tracker, box, int(stamp), replace)

    async def _do_reset(self) -> Answer:
        return await self._bridge.reset(self._tracker)

    async def _do_enable(self, on: bool) -> Answer:
        return await self._bridge.enable(self._tracker, on)

    async def _do_record(self, on: bool) -> Answer:
        return await self._bridge.record(self._tracker, on)

    async def _do_set(self, name: str, value: Any) -> Answer:
        answer = await self._bridge.set(self._tracker, name, value)
        self.tell(await self._bridge.parameters(self._tracker))
        return answer


def _now() -> float:
    return time.time()
