# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Start a tracker on a camera: ros2 launch het_ros tracker.launch.py camera:=/camera/image_raw."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

# Name, default and meaning; tracker.launch.xml has the same.
ARGUMENTS = (
    ("camera", "/camera/image_raw", "image topic; with transport compressed, without /compressed"),
    ("camera_info", "/camera/camera_info", "calibration of the camera: gives ~/bearing"),
    ("depth", "/camera/depth/image_raw", "depth registered to the camera: gives ~/target_pose"),
    ("transport", "raw", "raw or compressed"),
    ("namespace", "", "namespace of the node, for example the robot's name"),
    ("name", "tracker", "name of the node; its outputs are below it"),
    ("use_sim_time", "false", "take the time from /clock"),
    ("autostart", "true", "false leaves configuring and activating to a lifecycle manager"),
    ("operator", "false", "true serves the page on which a target is picked in a browser"),
    ("host", "localhost", "address of that page; 0.0.0.0 is every network, with a token"),
    ("port", "8642", "its port"),
)


def generate_launch_description() -> LaunchDescription:
    """The arguments and the nodes."""
    default_file = PathJoinSubstitution([FindPackageShare("het_ros"), "config", "tracker.yaml"])
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=meaning)
        for name, default, meaning in ARGUMENTS
    ]
    arguments += [
        DeclareLaunchArgument(
            "targets",
            default_value=LaunchConfiguration("name"),
            description="names of several nodes on the same images: left,right",
        ),
        DeclareLaunchArgument(
            "params_file", default_value=default_file, description="every other parameter"
        ),
    ]
    tracker = Node(
        package="het_ros",
        executable="tracker",
        # No name: it would be that of each target.
        arguments=["--targets", LaunchConfiguration("targets")],
        namespace=LaunchConfiguration("namespace"),
        output="screen",
        parameters=[
            LaunchConfiguration("params_file"),
            {
                "image_transport": LaunchConfiguration("transport"),
                "use_sim_time": LaunchConfiguration("use_sim_time"),
                "autostart": LaunchConfiguration("autostart"),
            },
        ],
        remappings=[
            ("image", LaunchConfiguration("camera")),
            ("camera_info", LaunchConfiguration("camera_info")),
            ("depth", LaunchConfiguration("depth")),
        ],
    )
    operator = Node(
        package="het_ros",
        executable="operator",
        namespace=LaunchConfiguration("namespace"),
        output="screen",
        condition=IfCondition(LaunchConfiguration("operator")),
        parameters=[
            {
                "host": LaunchConfiguration("host"),
                "port": LaunchConfiguration("port"),
                "use_sim_time": LaunchConfiguration("use_sim_time"),
            }
        ],
    )
    return LaunchDescription([*arguments, tracker, operator])
