# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math
from dataclasses import replace

import numpy as np
import pytest
from geometry_msgs.msg import TwistStamped
from rclpy.node import Node

from het_ros import Box, Estimate, State
from het_ros.ros.follower import Follower, FollowerConfig
from het_ros.ros.follower_example import FollowerNode
from het_ros.ros.messages import pose_from_estimate
from het_ros.ros.optics import bearing_message
from het_ros.ros.status import Status, status_message

from .streams import header_at

CONFIG = FollowerConfig()


def following(state=State.TRACKING, bearing=0.0, away=3.0, now=0.0) -> Follower:
    follower = Follower(CONFIG)
    follower.on_bearing(math.sin(bearing), math.cos(bearing), now)
    follower.on_place(away * math.sin(bearing), away * math.cos(bearing), now)
    follower.on_status(state, now)
    return follower


@pytest.mark.parametrize(
    "bearing, away, linear, angular",
    [
        (0.0, CONFIG.distance, 0.0, 0.0),
        (0.0, CONFIG.distance + 0.5, 0.4, 0.0),
        (0.0, CONFIG.distance - 0.5, -0.4, 0.0),
        (0.0, 20.0, CONFIG.max_linear, 0.0),
        (0.0, 0.1, -CONFIG.max_linear, 0.0),
        (0.2, CONFIG.distance, 0.0, -0.4),  # at the right: turn right, which is negative
        (-0.2, CONFIG.distance, 0.0, 0.4),
        (1.5, CONFIG.distance, 0.0, -CONFIG.max_angular),
        (math.pi, 20.0, 0.0, -CONFIG.max_angular),  # behind: turn, do not drive
    ],
)
def test_turns_to_the_target_and_keeps_the_distance(bearing, away, linear, angular):
    assert following(bearing=bearing, away=away).command(0.0) == pytest.approx((linear, angular))


def test_commands_come_near_what_is_wanted_in_time():
    follower = following(away=CONFIG.distance)
    commands = [follower.command(0.0)]
    for now in (CONFIG.ease, 2 * CONFIG.ease):
        follower.on_bearing(0.8, 0.6, now)
        follower.on_place(8.0, 6.0, now)
        follower.on_status(State.TRACKING, now)
        commands.append(follower.command(now))
    linear, angular = np.abs(commands).T
    assert linear[0] == 0 and 0.5 < linear[1] / linear[2] < 0.8
    assert angular[2] == pytest.approx((1 - math.exp(-2)) * CONFIG.max_angular)


def test_turns_by_the_bearing_where_the_place_is_not_fresh():
    follower = following(bearing=0.2)
    now = CONFIG.timeout + 0.1
    follower.on_bearing(-0.2, 1.0, now)
    follower.on_status(State.TRACKING, now)
    assert follower.command(now)[1] > 0


@pytest.mark.parametrize("state", [State.LOST, State.IDLE])
def test_stops_at_once_when_the_target_is_lost(state):
    follower = following(bearing=0.3)
    assert follower.command(0.1) != (0, 0)
    follower.on_status(state, 0.1)
    assert follower.command(0.1) == (0, 0)


def test_stops_within_half_a_second_of_silence():
    follower = following(bearing=0.3)
    assert follower.command(CONFIG.timeout - 0.01) != (0, 0)
    assert follower.command(CONFIG.timeout + 0.01) == (0, 0)
    assert CONFIG.timeout + 1 / CONFIG.rate < 0.5
    highest = FollowerConfig(timeout=0.45, rate=20.0)  # the table allows no more
    assert highest.timeout + 1 / highest.rate <= 0.5


def test_drives_on_slower_and_slower_while_the_target_is_hidden():
    follower = following(bearing=0.2, away=9.0)
    speeds = [follower.command(0.0)[0]]
    for i in range(1, 21):
        now = i * CONFIG.drive_on / 16
        follower.on_status(State.COASTING, now)
        linear, angular = follower.command(now)
        assert angular < 0.01, "it turns to where the target should be"
        speeds.append(linear)
    assert speeds[0] == CONFIG.max_linear
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[-5:] == [0.0] * 5
    assert speeds[3] > 0


def test_a_hidden_target_that_walks_on_is_met_where_it_comes_out():
    """It walks 0.8 m/s to the right, 4 m before a robot that may only turn."""
    follower, yaw, dt = Follower(replace(CONFIG, drive_gain=0.0)), 0.0, 0.05
    for i in range(80):
        now = i * dt
        bearing = math.atan2(0.8 * now, 4.0) - yaw
        hidden = i >= 40
        follower.on_status(State.COASTING if hidden else State.TRACKING, now)
        follower.on_bearing(0.0 if hidden else math.sin(bearing), math.cos(bearing), now)
        if not hidden:
            away = math.hypot(0.8 * now, 4.0)
            follower.on_place(away * math.sin(bearing), away * math.cos(bearing), now)
        _, angular = follower.command(now)
        yaw -= angular * dt
    assert abs(bearing) < 0.15


def test_turns_only_without_a_place():
    follower = Follower(CONFIG)
    follower.on_status(State.TRACKING, 0.0)
    follower.on_bearing(0.3, 1.0, 0.0)
    linear, angular = follower.command(0.0)
    assert linear == 0
    assert angular < 0


def test_a_pixel_is_a_bearing_where_the_image_width_is_known():
    follower = Follower(FollowerConfig(image_width=640.0, field_of_view=math.pi / 2))
    follower.on_status(State.TRACKING, 0.0)
    follower.on_pixel(640.0, 0.0)
    assert follower._bearing == pytest.approx(math.pi / 4)
    deaf = Follower(CONFIG)
    deaf.on_status(State.TRACKING, 0.0)
    deaf.on_pixel(640.0, 0.0)
    assert deaf.command(0.0) == (0, 0)


def test_not_a_number_does_not_drive():
    follower = following()
    follower.on_place(math.nan, 1.0, 0.0)
    follower.on_bearing(math.nan, 1.0, 0.0)
    assert follower.command(0.0) == (0, 0)


def test_the_node_publishes_commands_and_stops_when_the_tracker_falls_silent(graph):
    clock = [0.0]
    node = graph.add(FollowerNode(clock=lambda: clock[0], context=graph.context))
    got = []
    base = graph.add(Node("base", context=graph.context))
    base.create_subscription(TwistStamped, "cmd_vel", got.append, 10)
    graph.spin_until(lambda: got, "a first command")
    assert (got[-1].twist.linear.x, got[-1].twist.angular.z) == (0, 0)

    node.on_bearing(bearing_message(np.array([0.2, 0.0, 0.98]), header_at(1.0)))
    estimate = Estimate(Box(0, 0, 10, 10), (0.0, 0.0), np.eye(4), 1.0, State.TRACKING)
    node.on_pose(pose_from_estimate(estimate, header_at(1.0)))
    status = Status(State.TRACKING, 1.0, 0.01, 0.0, "")
    node.on_status(status_message(status, "tracker", header_at(1.0)))
    clock[0] = 0.1
    graph.spin_until(lambda: got[-1].twist.angular.z < 0, "a turn to the right")
    assert got[-1].header.frame_id == "base_link"
    clock[0] = 0.5
    graph.spin_until(lambda: got[-1].twist.angular.z == 0, "a stop")
