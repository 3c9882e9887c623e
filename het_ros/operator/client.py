# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One browser: what it asks for, within bounds, and what it is sent, at its own pace."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from contextlib import suppress
from typing import Any

from aiohttp import WSCloseCode, WSMsgType, web

from het_ros.operator.bridge import Bridge
from het_ros.operator.messages import Answer, MessageError, parse
from het_ros.operator.pictures import Picture
from het_ros.ros.images import ImageError

MOST_TEXTS = 300  # that wait for a slow browser; the oldest go first
ON_THE_WAY = 2  # images that a browser has not shown yet
BURST, A_SECOND = 200, 100  # messages of one browser
COMMAND = 10  # a command counts as so many messages
MOST_COMMANDS = 4  # at once


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
        self._commands: set[asyncio.Future[None]] = set()
        self._knows_parameters = False

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
                if message.type is not WSMsgType.TEXT or not self._on_text(message.data):
                    break
        finally:
            self._bridge.leave(self)
            for task in (sending, *self._commands):
                task.cancel()
            await asyncio.gather(sending, *self._commands, return_exceptions=True)
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

    def _on_text(self, text: str) -> bool:
        """Do what a message asks for; False where this browser is to be thrown out."""
        try:
            message = parse(text)
        except MessageError as error:
            self.tell(Answer(False, str(error)).message("unknown"))
            return self._allowance.take(COMMAND)
        kind = message.pop("type")
        if kind == "shown":
            self._on_the_way = max(self._on_the_way - 1, 0)
            self._news.set()
        elif kind == "ping":
            self.tell({"type": "pong", "now": time.time(), **message})
        else:
            self._start(kind, message)
            return self._allowance.take(COMMAND)
        return self._allowance.take(1)

    def _start(self, kind: str, message: dict[str, Any]) -> None:
        """Do a command beside the others: a tracker that does not answer holds up nothing."""
        if len(self._commands) >= MOST_COMMANDS:
            self.tell(Answer(False, "too much at once: try again").message(kind))
            return
        command = asyncio.ensure_future(self._do(kind, message))
        self._commands.add(command)
        command.add_done_callback(self._commands.discard)

    async def _do(self, kind: str, message: dict[str, Any]) -> None:
        bridge, tracker = self._bridge, self._tracker
        if kind == "view":
            await self._do_view(**message)
        elif kind == "freeze":
            await bridge.freeze(self, tracker, message["on"])
        else:
            answer = await getattr(bridge, kind)(tracker, **message)
            self.tell(answer.message(kind))
        if kind == "set":
            self.tell(await bridge.parameters(tracker))

    async def _do_view(self, tracker: str, width: float, quality: float) -> None:
        self._width, self._quality = int(width), int(quality)
        if tracker != self._tracker:
            self._tracker, self._picture, self._knows_parameters = tracker, None, False
        self._bridge.look(self, tracker)
        if tracker and not self._knows_parameters:
            found = await self._bridge.parameters(tracker)
            self._knows_parameters = bool(found["parameters"])
            self.tell(found)
