# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wait until another node knows our publishers, not only we its subscriptions.

Discovery has two directions. Where we count a subscriber already, it may not have heard of us yet,
and what we send to its best-effort subscription until then is lost without a trace: with the first
image goes the one that the box was drawn on.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

from het_ros.tools.interrupt import StopRequest

LONGEST_SPIN = 0.05  # s; so long may Ctrl-C take to be noticed
ASK_AGAIN = 1.0  # s without an answer: a request may be lost in discovery as well

Spin = Callable[[float], None]


class NobodyListensError(RuntimeError):
    """Nobody takes what is to be sent."""


def meet(
    node: Node,
    other: str,
    connected: Callable[[], bool],
    spin: Spin,
    seconds: float,
    stop: StopRequest,
    alive: Callable[[], None] = lambda: None,
) -> None:
    """Return when ``node`` and the node ``other`` have heard of each other.

    Args:
        node: as in :func:`wait_until_known`, which has the second part.
        other: name of a node, in the namespace of ``node`` if it is relative.
        connected: whether ``node`` has heard of all that it needs.
        spin: serves callbacks for at most so many seconds.
        seconds: to wait for each part.
        stop: ends the wait.
        alive: called often; may raise when waiting on makes no sense.

    Raises:
        NobodyListensError: they did not.
    """

    def spin_while_alive(left: float) -> None:
        alive()
        spin(left)

    end = time.monotonic() + seconds
    while not stop and not connected():
        if time.monotonic() > end:
            raise NobodyListensError(f"{other} is not heard after {seconds:g} s")
        spin_while_alive(LONGEST_SPIN)
    wait_until_known(node, other, spin_while_alive, seconds, stop)


def wait_until_known(
    node: Node, other: str, spin: Spin, seconds: float, stop: StopRequest
) -> None:
    """Return when the node ``other`` has heard of all that ``node`` publishes and subscribes to.

    It is asked for no parameters. DDS announces the endpoints of a process in the order in which
    they were made, so who answers a client that was made last knows all that came before it.

    Args:
        node: its publishers and subscriptions exist by now; ``spin`` serves it.
        other: name of a node, of which its parameter services are used.
        spin: serves callbacks for at most so many seconds.
        seconds: to wait for an answer.
        stop: ends the wait.

    Raises:
        NobodyListensError: no answer came.
    """
    client = node.create_client(GetParameters, f"{other}/get_parameters")
    try:
        end, asked, answer = time.monotonic() + seconds, -ASK_AGAIN, None
        while not stop and not (answer and answer.done()):
            now = time.monotonic()
            if now > end:
                raise NobodyListensError(
                    f"{other} is there, but does not answer {client.service_name}: is it "
                    "stopped or very busy?"
                )
            if client.service_is_ready() and now - asked >= ASK_AGAIN:
                asked, answer = now, client.call_async(GetParameters.Request())
            spin(LONGEST_SPIN)
    finally:
        node.destroy_client(client)
