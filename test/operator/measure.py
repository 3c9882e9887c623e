# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the operator's page costs and stands, measured on this machine.

live      pictures/s and latency from the camera's stamp to the canvas in Chromium
tracker   the tracker's own latency and CPU time with and without three clients, in turns
hostile   100 000 random and hostile messages and 200 connections: memory, faults, other clients

example: python test/operator/measure.py live tracker hostile
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path

import aiohttp
import numpy as np
import rclpy
from operator_browser import OperatorPage, chromium, wait
from rclpy.executors import SingleThreadedExecutor

from het_ros.operator.demo import Camera
from het_ros.ros.messages import header_of, polygon_from_box
from het_ros.ros.status import status_values
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.run import shipped_bag
from het_ros.tools.tracker_arguments import tracker_arguments
from het_ros.tools.tracker_process import TrackerProcess, find_tracker, own_graph
from het_ros.tools.transport import use_profile

VIEWS = [
    {"type": "view", "tracker": "/tracker", "width": width, "quality": 70}
    for width in (320, 480, 640)
]


class Running:
    """Camera, tracker and operator in a ROS domain of their own; the camera plays in a thread.

    Attributes:
        url: of the page.
        operator: its process.
        log: of the operator.
        latencies: ms of the tracker, by arrival of its status.
    """

    def __init__(self, things: ExitStack) -> None:
        from diagnostic_msgs.msg import DiagnosticArray
        from geometry_msgs.msg import PolygonStamped

        os.environ.update(own_graph())
        use_profile()
        folder = Path(things.enter_context(tempfile.TemporaryDirectory()))
        rclpy.init()
        things.callback(rclpy.try_shutdown)
        self._node = rclpy.create_node("measure")
        bag = things.enter_context(BagReader(shipped_bag()))
        self._truth = bag.truth()
        self._camera = Camera(self._node, bag)
        tracker, self.log = find_tracker(), folder / "operator.log"
        self._tracker = things.enter_context(
            TrackerProcess(tracker, tracker_arguments(bag), folder / "tracker.log")
        )
        page = tracker.with_name("operator")
        arguments = ["--ros-args", "-p", "port:=0"]
        self.operator = things.enter_context(TrackerProcess(page, arguments, self.log))
        self.latencies: list[float] = []
        self._state = ""
        self._boxes = self._node.create_publisher(PolygonStamped, "/tracker/init_box", 10)
        self._node.create_subscription(DiagnosticArray, "/tracker/status", self._on_status, 10)
        self._playing = True
        thread = threading.Thread(target=self._play)
        thread.start()
        things.callback(thread.join)
        things.callback(setattr, self, "_playing", False)
        words = lambda: self.log.read_text().split()  # noqa: E731
        self.url = wait(lambda: next((w for w in words() if "http" in w), ""), "an address")

    def _on_status(self, message) -> None:
        values = status_values(message)
        self._state = values["state"]
        self.latencies.append(float(values["latency_ms"]))

    def _play(self) -> None:
        executor = SingleThreadedExecutor()
        executor.add_node(self._node)
        while self._playing:
            executor.spin_once(timeout_sec=min(max(self._camera.seconds_left(), 0), 0.01))
            if self._camera.seconds_left() <= 0:
                self._camera.send()

    def start_track(self) -> None:
        """Start on the truth; again where it was lost."""
        while self._state != "TRACKING":
            stamp, recorded = list(self._camera.played.items())[-1]
            self._boxes.publish(polygon_from_box(self._truth[recorded], header_of(stamp)))
            time.sleep(0.5)

    def work(self) -> float:
        """CPU time that the tracker has used, ms; what others do on the machine does not count."""
        fields = Path(f"/proc/{self._tracker.pid}/stat").read_text().rpartition(")")[2].split()
        return 1000 * (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self) -> float:
        """Resident memory of the operator, MB."""
        status = Path(f"/proc/{self.operator.pid}/status").read_text()
        return int(status.split("VmRSS:")[1].split()[0]) / 1000


@contextmanager
def running():
    """A :class:`Running`."""
    with ExitStack() as things:
        yield Running(things)


async def watch(url: str, view: dict, until: asyncio.Event) -> int:
    """Look as a page does; how many images came."""
    images = 0
    async with aiohttp.ClientSession() as session, session.ws_connect(f"{url}socket") as socket:
        await socket.send_json(view)
        while not until.is_set():
            message = await socket.receive()
            if message.type is aiohttp.WSMsgType.BINARY:
                images += 1
                await socket.send_json({"type": "shown"})
            elif message.type is not aiohttp.WSMsgType.TEXT:
                raise RuntimeError(f"the server ended it: {message}")
    return images


def live(seconds: float) -> None:
    """Rate and latency of the page, in windows of 5 s."""
    with running() as world, chromium() as browser:
        page = OperatorPage(browser.new_page(viewport={"width": 1280, "height": 720}), world.url)
        page.wait_for_pictures()
        world.start_track()
        time.sleep(6)
        for _ in range(round(seconds / 5)):
            time.sleep(5)
            found = page.get("operatorPage.figures.all")
            print(
                f"live: {found['rate']:.1f} pictures/s, latency median {found['median']:.0f} ms, "
                f"p95 {found['p95']:.0f} ms, dropped so far {found['dropped']}, {_load()}"
            )


def tracker(seconds: float) -> None:
    """The tracker's latency with 0 and 3 clients, in turns of some seconds."""
    found: dict[int, list[float]] = {0: [], 3: []}
    work = {0: 0.0, 3: 0.0}
    with running() as world:
        for turn in range(6):
            clients = 3 * (turn % 2)
            world.start_track()
            latencies, used = asyncio.run(_turn(world, clients, seconds / 6))
            found[clients] += latencies
            work[clients] += used
            print(f"tracker: {clients} clients, {len(found[clients])} frames, {_load()}")
    for clients, latencies in found.items():
        median, p95 = np.percentile(latencies, (50, 95))
        cpu = work[clients] / len(latencies)
        print(
            f"tracker: {clients} clients: median {median:.2f} ms, p95 {p95:.2f} ms, "
            f"CPU {cpu:.2f} ms a frame"
        )


async def _turn(world: Running, clients: int, seconds: float) -> tuple[list[float], float]:
    stop = asyncio.Event()
    watching = [asyncio.ensure_future(watch(world.url, v, stop)) for v in VIEWS[:clients]]
    await asyncio.sleep(2)
    first, used = len(world.latencies), world.work()
    await asyncio.sleep(seconds)
    latencies, used = world.latencies[first:], world.work() - used
    stop.set()
    await asyncio.gather(*watching)
    return latencies, used


def hostile(messages: int) -> None:
    """Attack the operator's process; its memory, and what a good client sees meanwhile."""
    from test_server import attack

    with running() as world:
        asyncio.run(_attack(world, attack, messages))
        said = world.log.read_text()
        print(
            f"hostile: {said.count('Traceback')} tracebacks, {said.count('ERROR')} errors logged"
        )
        world.operator.check()


async def _attack(world: Running, attack, messages: int) -> None:
    class Address:
        url = world.url

    stop = asyncio.Event()
    good = asyncio.ensure_future(watch(world.url, VIEWS[2], stop))
    await asyncio.sleep(5)
    for part in range(10):
        begin = time.monotonic()
        await attack(Address, random.Random(part), messages // 10)
        sent = (part + 1) * messages // 10
        print(
            f"hostile: {sent} messages, {world.memory():.1f} MB, "
            f"{messages / 10 / (time.monotonic() - begin):.0f} a second, {_load()}"
        )
    async with aiohttp.ClientSession() as session:
        for _ in range(200):
            socket = await session.ws_connect(f"{world.url}socket")
            await socket.send_str(json.dumps(VIEWS[0]))
            await socket.close()
    print(f"hostile: 200 connections more, {world.memory():.1f} MB")
    stop.set()
    print(f"hostile: the good client saw {await good} images meanwhile")


def _load() -> str:
    return f"load {os.getloadavg()[0]:.1f}"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", nargs="+", choices=["live", "tracker", "hostile"])
    parser.add_argument("--seconds", type=float, default=60.0, help="of live and tracker")
    parser.add_argument("--messages", type=int, default=100_000, help="of hostile")
    options = parser.parse_args()
    for what in options.what:
        if what == "hostile":
            hostile(options.messages)
        else:
            {"live": live, "tracker": tracker}[what](options.seconds)


if __name__ == "__main__":
    main()
