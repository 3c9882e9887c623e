# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest
import rclpy
from graph import PATIENCE
from std_msgs.msg import Header

from het_ros.tools.handshake import NobodyListensError, meet, wait_until_known
from het_ros.tools.interrupt import StopRequest


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


def test_both_directions_are_waited_for(graph):
    ours = graph.add(rclpy.create_node("ours", context=graph.context))
    tracker = graph.add(rclpy.create_node("tracker", context=graph.context))
    heard = tracker.create_subscription(Header, "/image", lambda _: None, 1)
    images = ours.create_publisher(Header, "/image", 1)

    def seen() -> bool:
        return images.get_subscription_count() == 1

    meet(ours, "/tracker", seen, spinning(graph), PATIENCE, StopRequest())
    assert seen() and heard.get_publisher_count() == 1


def test_who_is_not_found_is_told_and_who_has_ended_at_once(graph):
    ours = graph.add(rclpy.create_node("ours", context=graph.context))
    with pytest.raises(NobodyListensError, match="/tracker is not heard after"):
        meet(ours, "/tracker", lambda: False, spinning(graph), 0.1, StopRequest())

    def alive() -> None:
        raise OSError("it has ended")

    for connected in (lambda: False, lambda: True):
        with pytest.raises(OSError, match="has ended"):
            meet(ours, "/tracker", connected, spinning(graph), PATIENCE, StopRequest(), alive)
