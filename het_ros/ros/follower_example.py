# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executable ``follower_example``: what a robot may do with the tracker's outputs.

It is no part of the tracker, and no more than an example: it knows nothing of obstacles.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import (
    PoseStamped,
    PoseWithCovarianceStamped,
    TwistStamped,
    TwistWithCovarianceStamped,
    Vector3Stamped,
)
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from het_ros.ros.follower import Follower, FollowerConfig
from het_ros.ros.parameters import declare, read
from het_ros.ros.start import CtrlC, own_arguments, start_ros
from het_ros.ros.status import status_values
from het_ros.tracking.estimate import State


class FollowerNode(Node):
    """Reads the tracker's outputs and writes ``cmd_vel``.

    It takes ``tracker/status``, ``bearing``, ``pose``, ``target_pose`` and ``target_velocity``.

    Args:
        clock: s, monotonic; a simulation gives its own and calls :meth:`tick` itself.
        **options: of rclpy's Node.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic, **options: Any) -> None:
        super().__init__("follower_example", **options)
        declare(self, FollowerConfig())
        self.follower = Follower(read(self, FollowerConfig))
        self._now = clock
        self._commands = self.create_publisher(TwistStamped, "cmd_vel", 10)
        for topic, kind, callback in (
            ("status", DiagnosticArray, self.on_status),
            ("bearing", Vector3Stamped, self.on_bearing),
            ("pose", PoseWithCovarianceStamped, self.on_pose),
            ("target_pose", PoseStamped, self.on_target_pose),
            ("target_velocity", TwistWithCovarianceStamped, self.on_target_velocity),
        ):
            self.create_subscription(kind, f"tracker/{topic}", callback, 1)
        config = self.follower.config
        self.get_logger().info(
            f"follows {self.resolve_topic_name('tracker/status')} at {config.distance:g} m, "
            f"commands on {self.resolve_topic_name('cmd_vel')}"
        )
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1 / self.follower.config.rate, self.tick, clock=steady)

    def on_status(self, message: DiagnosticArray) -> None:
        """Take ``~/status``."""
        state = status_values(message)["state"] if message.status else State.LOST.value
        self.follower.on_status(State(state), self._now())

    def on_bearing(self, message: Vector3Stamped) -> None:
        """Take ``~/bearing``."""
        self.follower.on_bearing(message.vector.x, message.vector.z, self._now())

    def on_pose(self, message: PoseWithCovarianceStamped) -> None:
        """Take ``~/pose``, used where the image's width is set."""
        self.follower.on_pixel(message.pose.pose.position.x, self._now())

    def on_target_pose(self, message: PoseStamped) -> None:
        """Take ``~/target_pose``."""
        place = message.pose.position
        self.follower.on_place(place.x, place.z, self._now())

    def on_target_velocity(self, message: TwistWithCovarianceStamped) -> None:
        """Take ``~/target_velocity``."""
        linear = message.twist.twist.linear
        self.follower.on_velocity(linear.x, linear.z, self._now())

    def tick(self) -> tuple[float, float]:
        """Publish the command of this moment, and return it (m/s, rad/s)."""
        linear, angular = self.follower.command(self._now())
        message = TwistStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "base_link"
        message.twist.linear.x, message.twist.angular.z = linear, angular
        self._commands.publish(message)
        return linear, angular


def main(args: list[str] | None = None) -> int:
    """Run the follower until it is told to stop."""
    argv = sys.argv if args is None else ["follower_example", *args]
    parser = argparse.ArgumentParser(
        prog="follower_example",
        description="Drive after what the tracker tracks; stop when it is LOST or silent.",
        epilog="example: ros2 run het_ros follower_example --ros-args -p distance:=1.5 "
        "-r cmd_vel:=/robot/cmd_vel",
    )
    with CtrlC() as ctrl_c:
        try:
            parser.parse_args(own_arguments(argv))
            start_ros(argv)
            if not ctrl_c.asked:
                rclpy.spin(FollowerNode())
        except ExternalShutdownException:
            pass
        except (ParameterException, ValueError) as error:
            print(f"follower_example: {error}", file=sys.stderr)
            return 2
        except Exception:
            if rclpy.ok():  # else a signal came while the node was being made
                raise
        finally:
            rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
