# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest
import rclpy
from graph import PATIENCE
from std_msgs.msg import Header

from het_ros.tools.handshake import wait_until_known
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.player import NobodyListensError


def spinning(graph):
    return lambda seconds: graph.executor.spin_once(timeout_sec=seconds)


def test_who_answers_knows_the_publisher(graph):
    ours = graph.add(rclpy.create_node("ours", context=graph.context))
    tracker = graph.add(rclpy.create_node("tracker", context=graph.context))
    heard = tracker.create_subscription(Header, "/image", lambda _: None, 1)
    ours.create_publisher(Header, "/image", 1)
    wait_until_known(ours, "/tracker", spinning(graph), PATIENCE, StopRequest())
    assert heard.get_publisher_count() == 1
    assert not list(ours.clients)


def test_silence_is_told(graph):
    ours = graph.add(rclpy.create_node("ours", context=graph.context))
    graph.keep(rclpy.create_node("tracker", context=graph.context))
    with pytest.raises(NobodyListensError, match="/tracker is there, but does not answer"):
        wait_until_known(ours, "/tracker", spinning(graph), 0.3, StopRequest())


def test_a_stop_ends_the_wait(graph):
    ours = graph.add(rclpy.create_node("ours", context=graph.context))
    stop = StopRequest()

    def spin(_: float) -> None:
        stop.requested = True

    wait_until_known(ours, "/tracker", spin, PATIENCE, stop)
