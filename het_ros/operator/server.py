# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The web server: the page's files, and a socket for each browser that may have one."""

from __future__ import annotations

import hmac
import mimetypes
from pathlib import Path
from urllib.parse import urlsplit

from aiohttp import WSCloseCode, web

from het_ros.operator.client import Bridge, Client
from het_ros.operator.config import OperatorConfig
from het_ros.operator.messages import LONGEST

STATIC = Path(__file__).parent / "static"
LOCAL = ("localhost", "127.0.0.1", "::1")
HEARTBEAT = 10.0  # s after which a browser that does not answer is gone
HEADERS = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' blob:; "
    "connect-src 'self' ws: wss:; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
}


class Server:
    """Serves browsers from a bridge.

    Args:
        bridge: where images and answers come from.
        config: host, port and the number of browsers.
        token: what browsers have to know; empty lets every browser of this machine in.
    """

    def __init__(self, bridge: Bridge, config: OperatorConfig, token: str) -> None:
        self._bridge = bridge
        self._config = config
        self._token = token
        self._sockets: set[web.WebSocketResponse] = set()
        self._files = {
            path.name: (path.read_bytes(), mimetypes.guess_type(path.name)[0] or "text/plain")
            for path in STATIC.iterdir()
            if path.is_file()
        }
        app = web.Application(client_max_size=LONGEST)
        app.router.add_get("/check", self._check)
        app.router.add_get("/socket", self._connect)
        app.router.add_get("/{name:[a-z_.]*}", self._file)
        self._runner = web.AppRunner(app, access_log=None)
        self.port = config.port

    @property
    def clients(self) -> int:
        """Number of connected browsers."""
        return len(self._sockets)

    async def start(self) -> None:
        """Listen; raises OSError where the address is taken or none of this machine."""
        await self._runner.setup()
        await web.TCPSite(self._runner, self._config.host, self._config.port).start()
        self.port = self._runner.addresses[0][1]

    async def close(self) -> None:
        """Take leave of every browser and stop listening."""
        for socket in tuple(self._sockets):
            await socket.close(code=WSCloseCode.GOING_AWAY)
        await self._runner.cleanup()

    async def _file(self, request: web.Request) -> web.Response:
        found = self._files.get(request.match_info["name"] or "index.html")
        if found is None:
            raise web.HTTPNotFound
        return web.Response(body=found[0], content_type=found[1], headers=HEADERS)

    async def _check(self, request: web.Request) -> web.Response:
        """Why a socket is refused, which a browser does not tell a page."""
        return self._refusal(request) or web.Response(text="welcome", headers=HEADERS)

    async def _connect(self, request: web.Request) -> web.StreamResponse:
        refusal = self._refusal(request)
        if refusal is not None:
            return refusal
        socket = web.WebSocketResponse(
            heartbeat=HEARTBEAT, max_msg_size=LONGEST, compress=False, timeout=2.0
        )
        self._sockets.add(socket)
        try:
            await socket.prepare(request)
            await Client(socket, self._bridge).serve()
        finally:
            self._sockets.discard(socket)
        return socket

    def _refusal(self, request: web.Request) -> web.Response | None:
        """The answer to who may not connect; None to who may."""
        host = urlsplit(f"//{request.host}").hostname
        if self._config.local and host not in LOCAL:
            return _refused(403, f"{request.host} is not this machine's own name")
        origin = request.headers.get("Origin")
        if origin is not None and urlsplit(origin).netloc != request.host:
            return _refused(403, f"a page of {origin} has no business here")
        token = request.query.get("token", "")
        if self._token and not hmac.compare_digest(token.encode(), self._token.encode()):
            return _refused(403, "the token is wrong: open the address that the operator printed")
        if len(self._sockets) >= self._config.max_clients:
            return _refused(503, f"{len(self._sockets)} browsers are connected: max_clients")
        return None


def _refused(status: int, text: str) -> web.Response:
    return web.Response(status=status, text=text, headers=HEADERS)
