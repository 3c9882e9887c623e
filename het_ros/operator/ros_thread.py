# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A thread in which a node is spun, and the way there and back from an asynchronous loop."""

from __future__ import annotations

import asyncio
import concurrent.futures
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

Result = TypeVar("Result")
PATIENCE = 5.0  # s for a service's answer
POLL = 0.05  # s


class RosThread:
    """Spins a node; one callback runs at a time, so what belongs to ROS needs no lock.

    Args:
        node: nobody else spins it.
    """

    def __init__(self, node: Node) -> None:
        self.node = node
        self._loop = asyncio.get_running_loop()
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._open = True
        self._thread = threading.Thread(target=self._spin, name="ros", daemon=True)
        self._thread.start()

    async def close(self) -> None:
        """Stop spinning."""
        self._open = False
        self._executor.wake()
        await asyncio.to_thread(self._thread.join)
        self._executor.shutdown()

    def _spin(self) -> None:
        while self._open and self.node.context.ok():
            try:
                self._executor.spin_once(timeout_sec=1.0)
            except ExternalShutdownException:
                return
            except Exception as error:  # a fault in one message must not blind the page
                self.node.get_logger().error(f"a message was left out: {error!r}")

    def later(self, work: Callable[[], Any]) -> None:
        """Let the node's thread do something."""
        self._executor.create_task(work)

    async def do(self, work: Callable[[], Result]) -> Result:
        """The result of something that the node's thread does."""
        done: concurrent.futures.Future[Result] = concurrent.futures.Future()

        def run() -> None:
            try:
                done.set_result(work())
            except Exception as error:
                done.set_exception(error)

        self._executor.create_task(run)
        return await asyncio.shield(asyncio.wrap_future(done))

    def in_loop(self, call: Callable[..., None], *things: Any) -> None:
        """Let the loop's thread call something; nothing happens once the loop is closed."""
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(call, *things)

    async def call(self, kind: Any, name: str, request: Any) -> Any:
        """The response of a service.

        Raises:
            TimeoutError: it is not there, or nobody answers.
        """
        client = await self.do(lambda: self.node.create_client(kind, name))
        try:
            return await asyncio.wait_for(self._answer(client, request), PATIENCE)
        except asyncio.TimeoutError:
            raise TimeoutError(f"{name} does not answer") from None
        finally:
            self.later(lambda: self.node.destroy_client(client))

    async def _answer(self, client: Any, request: Any) -> Any:
        while not await self.do(client.service_is_ready):
            await asyncio.sleep(POLL)
        answered = asyncio.Event()
        future = await self.do(lambda: client.call_async(request))
        future.add_done_callback(lambda _: self.in_loop(answered.set))
        await answered.wait()
        return future.result()
