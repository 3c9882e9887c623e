# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executable ``tracker``."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence

import rclpy
from rclpy.exceptions import InvalidNodeNameException, ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

from het_ros.ros.managed_node import StartError
from het_ros.ros.start import CtrlC, ended_by_ctrl_c, own_arguments, start_ros

DEFAULT_NAME = "tracker"
# What may be wrong with what the user gave: told in one line.
WRONG = (InvalidNodeNameException, ParameterException, StartError, ValueError)


def names_of(targets: str, arguments: Sequence[str]) -> list[str]:
    """The names of the nodes.

    Args:
        targets: names, parted by commas; empty for one node of the usual name.
        arguments: ROS's own, which may rename a node.

    Raises:
        ValueError: two nodes would have one name.
    """
    names = [name.strip() for name in targets.split(",")] if targets else [DEFAULT_NAME]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"--targets names {', '.join(twice)} twice: each target needs its own")
    renames = [a for a in arguments if re.fullmatch(r"(--remap=)?__(node|name):=.*", a)]
    if len(names) > 1 and renames:
        raise ValueError(
            f"{renames[0]} would give all of --targets {targets} one name: leave it out, the "
            "nodes are named by --targets"
        )
    return names


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
    with CtrlC() as ctrl_c:
        try:
            options = parser.parse_args(own_arguments(argv))
            return _run(names_of(options.targets, argv), argv, ctrl_c)
        except WRONG as error:
            print(f"tracker: {error}", file=sys.stderr)
            return 2


def _run(names: Sequence[str], argv: Sequence[str], ctrl_c: CtrlC) -> int:
    with ended_by_ctrl_c():
        from het_ros.ros.threads import one_thread
        from het_ros.ros.tracker_node import TrackerNode
    nodes: list[TrackerNode] = []
    one_thread()
    try:
        start_ros(argv)
        if ctrl_c.asked:  # before rclpy heard it
            return 0
        executor = SingleThreadedExecutor()
        for name in names:
            nodes.append(TrackerNode(name, source=nodes[0] if nodes else None))
            executor.add_node(nodes[-1])
        executor.spin()
    except ExternalShutdownException:
        pass
    except WRONG:
        raise
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
