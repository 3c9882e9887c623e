"""The executable ``tracker``."""

from __future__ import annotations

import argparse
import sys

import rclpy
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.utilities import remove_ros_args

from het_ros.ros.tracker_node import TrackerNode


def main(args: list[str] | None = None) -> int:
    """Run the node until it is told to stop; 0 on a clean stop, 2 on a wrong parameter."""
    argv = sys.argv if args is None else ["tracker", *args]
    parser = argparse.ArgumentParser(
        prog="tracker",
        description="Follow one target on a camera stream.",
        epilog="example: ros2 run het_ros tracker --ros-args -r image:=/camera/image_raw",
    )
    parser.parse_args(remove_ros_args(argv)[1:])
    node = None
    try:
        rclpy.init(args=argv)
        node = TrackerNode()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except (ParameterException, ValueError) as error:
        print(f"tracker: {error}", file=sys.stderr)
        return 2
    except Exception:
        if rclpy.ok():  # else a signal came while the node was being made
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
