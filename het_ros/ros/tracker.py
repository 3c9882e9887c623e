# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executable ``tracker``."""

from __future__ import annotations

import argparse
import sys

import rclpy
from rclpy.exceptions import InvalidNodeNameException, ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.utilities import remove_ros_args

from het_ros.ros.start import ended_by_ctrl_c


def main(args: list[str] | None = None) -> int:
    """Run the node until it is told to stop; 0 on a clean stop, 2 on a wrong parameter."""
    argv = sys.argv if args is None else ["tracker", *args]
    parser = argparse.ArgumentParser(
        prog="tracker",
        description="Follow one target on a camera stream.",
        epilog="example: ros2 run het_ros tracker --ros-args -r image:=/camera/image_raw",
    )
    parser.add_argument(
        "--targets",
        default="",
        help="names of several nodes on the same images, each with its own target: left,right",
    )
    options = parser.parse_args(remove_ros_args(argv)[1:])
    with ended_by_ctrl_c():
        from het_ros.ros.threads import one_thread
        from het_ros.ros.tracker_node import TrackerNode
    nodes: list[TrackerNode] = []
    one_thread()
    try:
        rclpy.init(args=argv)
        executor = SingleThreadedExecutor()
        for name in options.targets.split(",") if options.targets else ["tracker"]:
            nodes.append(TrackerNode(name, source=nodes[0] if nodes else None))
            executor.add_node(nodes[-1])
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except (InvalidNodeNameException, ParameterException, ValueError) as error:
        print(f"tracker: {error}", file=sys.stderr)
        return 2
    except Exception:
        if rclpy.ok():  # else a signal came while the node was being made
            raise
    finally:
        for node in nodes:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
