# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Wait until another node knows our publishers, not only we its subscriptions.

Discovery has two directions. Where we count a subscriber already, it may not have heard of us yet,
and what we send to its best-effort subscription until then is lost without a trace: with the first
image goes the one that the box was drawn on.
"""

from __future__ import annotations

import time

from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

from het_ros.tools.interrupt import StopRequest
from het_ros.tools.player import LONGEST_SPIN, NobodyListensError, Spin

ASK_AGAIN = 1.0  # s without an answer: a request may be lost in discovery as well


def wait_until_known(
    node: Node, other: str, spin: Spin, seconds: float, stop: StopRequest
) -> None:
    """Return when the node ``other`` has heard of all that ``node`` publishes and subscribes to.

    It is asked for no parameters. DDS announces the endpoints of a process in the order in which
    they were made, so who answers a client that was made last knows all that came before it.

    Args:
        node: its publishers and subscriptions exist by now; ``spin`` serves it.
        other: full name of a node, of which its parameter services are used.
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
