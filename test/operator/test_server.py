# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Who may connect, and what a client that means no good can do: nothing to others."""

from __future__ import annotations

import asyncio
import json
import random
from concurrent.futures import ThreadPoolExecutor

import aiohttp
import pytest
from jsonschema import Draft202012Validator
from operator_browser import wait

from het_ros.operator.messages import LONGEST, SCHEMA

VIEW = {"type": "view", "tracker": "/tracker", "width": 640, "quality": 70}


def run(work):
    """What a coroutine returns; in a thread, since Playwright keeps a loop running in this one."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, asyncio.wait_for(work, 120)).result()


async def status_of(server, token: str = "", **headers) -> int:
    async with (
        aiohttp.ClientSession() as session,
        session.get(f"{server.url}check?token={token}", headers=headers) as response,
    ):
        return response.status


@pytest.mark.parametrize(
    "headers, status",
    [
        ({}, 200),
        ({"Origin": "http://localhost:PORT"}, 200),
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Host": "evil.example:PORT", "Origin": "http://evil.example:PORT"}, 403),
        ({"Host": "127.0.0.1:PORT"}, 200),
    ],
)
def test_other_sites_and_names_are_refused(server, headers, status):
    port = str(server.server.port)
    headers = {name: value.replace("PORT", port) for name, value in headers.items()}
    assert run(status_of(server, **headers)) == status


@pytest.mark.parametrize("token, status", [("secret", 200), ("", 403), ("Secret", 403)])
def test_a_token_is_needed_where_there_is_one(serve, token, status):
    assert run(status_of(serve(token="secret"), token)) == status


def test_without_the_token_there_is_no_socket(serve):
    server = serve(token="secret")

    async def connect():
        async with aiohttp.ClientSession() as session:
            await session.ws_connect(f"{server.url}socket?token=guess")

    with pytest.raises(aiohttp.WSServerHandshakeError, match="403"):
        run(connect())


@pytest.mark.parametrize(
    "path", ["../config.py", "..%2fserver.py", "nothing.js", "static/main.js"]
)
def test_only_the_page_s_files_are_given_out(server, path):
    async def get():
        async with (
            aiohttp.ClientSession() as session,
            session.get(f"{server.url}{path}") as response,
        ):
            return response.status

    assert run(get()) == 404


def test_no_more_than_max_clients(serve):
    server = serve(max_clients=2)

    async def connect():
        async with aiohttp.ClientSession() as session:
            both = [await session.ws_connect(f"{server.url}socket") for _ in range(2)]
            refused = await status_of(server)
            assert not any(socket.closed for socket in both)
            return refused

    assert run(connect()) == 503
    wait(lambda: server.server.clients == 0, "both have gone")
    assert run(status_of(server)) == 200


def test_what_the_server_sends_is_as_the_schema_says(server):
    check = Draft202012Validator(SCHEMA)

    async def listen():
        kinds = set()
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(f"{server.url}socket") as socket,
        ):
            requests = [VIEW, {"type": "ping", "time": 1.5}, {"type": "reset"}]
            requests += [{"type": "record", "on": True}, {"type": "nonsense"}]
            for request in requests:
                check.validate(request) if request["type"] != "nonsense" else None
                await socket.send_json(request)
            while len(kinds) < 7:
                message = await socket.receive()
                if message.type is aiohttp.WSMsgType.BINARY:
                    end = 4 + int.from_bytes(message.data[:4], "little")
                    told = json.loads(message.data[4:end])
                    await socket.send_json({"type": "shown"})
                else:
                    told = json.loads(message.data)
                check.validate(told)
                kinds.add(told["type"])
        return kinds

    assert run(listen()) == {
        "trackers", "parameters", "image", "track", "answer", "recording", "pong",
    }  # fmt: skip


async def numbers_seen(socket, count: int) -> list[int]:
    """Numbers of the next images; each is acknowledged."""
    numbers: list[int] = []
    while len(numbers) < count:
        message = await socket.receive()
        assert message.type in (aiohttp.WSMsgType.BINARY, aiohttp.WSMsgType.TEXT)
        if message.type is aiohttp.WSMsgType.BINARY:
            end = 4 + int.from_bytes(message.data[:4], "little")
            numbers.append(json.loads(message.data[4:end])["number"])
            await socket.send_json({"type": "shown"})
    return numbers


def test_a_client_that_does_not_keep_up_gets_the_newest_and_holds_up_nobody(server):
    async def watch():
        async with aiohttp.ClientSession() as session:
            slow, fast = [await session.ws_connect(f"{server.url}socket") for _ in range(2)]
            await slow.send_json(VIEW)
            await fast.send_json(VIEW)
            seen = await numbers_seen(fast, 20)
            return seen, await numbers_seen(slow, 4)

    fast, slow = run(watch())
    assert fast == sorted(set(fast))
    assert slow[1] < fast[5]
    assert slow[2] >= fast[-1] - 5  # the two on their way are old, the next is new


async def attack(server, rng: random.Random, messages: int) -> int:
    """Send random and hostile messages, on a new socket when thrown out; how many were sent."""
    sent = 0
    async with aiohttp.ClientSession() as session:
        while sent < messages:
            async with session.ws_connect(f"{server.url}socket", max_msg_size=0) as socket:
                try:
                    while sent < messages and not socket.closed:
                        sent += 1
                        await hostile(socket, rng)
                        if sent % 5 == 0:
                            await asyncio.sleep(0.0005)  # the server reads before it closes
                except (ConnectionError, aiohttp.ClientError):
                    pass
    return sent


async def hostile(socket, rng: random.Random) -> None:
    kind = rng.randrange(8)
    if kind == 0:
        await socket.send_bytes(rng.randbytes(rng.randrange(200)))
    elif kind == 1:
        await socket.send_str("x" * rng.choice([1, LONGEST - 1, LONGEST + 1, 100_000]))
    elif kind == 2:
        await socket.send_str("[" * rng.randrange(LONGEST))
    elif kind == 3:
        await socket.send_json({"type": rng.choice(["pick", "view", "set", "dance"])})
    elif kind == 4:
        name = "".join(chr(rng.randrange(1, 0xD800)) for _ in range(20))
        await socket.send_json(VIEW | {"tracker": name, "width": rng.randrange(16, 4097)})
    elif kind == 5:
        box = [rng.uniform(-1e5, 1e5) for _ in range(2)] + [rng.uniform(1e-9, 1e5)] * 2
        stamp = str(rng.randrange(10**19))
        await socket.send_json({"type": "pick", "box": box, "stamp": stamp, "replace": True})
    elif kind == 6:
        await socket.send_json(
            {"type": "set", "name": "seed", "value": rng.uniform(-1e300, 1e300)}
        )
    else:
        await socket.send_json({"type": rng.choice(["shown", "reset"])})


def test_hostile_clients_change_nothing_for_others(server):
    async def both():
        async with aiohttp.ClientSession() as session:
            good = await session.ws_connect(f"{server.url}socket")
            await good.send_json(VIEW)
            attackers = [
                asyncio.ensure_future(attack(server, random.Random(seed), 1000)) for seed in (1, 2)
            ]
            seen = await numbers_seen(good, 30)
            await asyncio.gather(*attackers)
            return seen, await numbers_seen(good, 5)

    seen, after = run(both())
    assert seen[0] < after[0]
    wait(lambda: server.server.clients == 0, "all have gone")
    assert not server.bridge.viewers
