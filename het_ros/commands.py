# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executables: which module runs each, and what is said where a package of one is missing.

``ros2 run het_ros NAME`` runs them by their names here. Whoever installs the package by pip gets
them on the PATH, where ``run`` or ``play`` could be anybody's: there they are ``het_ros_NAME``.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from importlib import import_module

COMMANDS = {
    "tracker": "het_ros.ros.tracker",
    "follower_example": "het_ros.ros.follower_example",
    "make_bag": "het_ros.tools.make_bag",
    "make_scene_bag": "het_ros.tools.make_scene_bag",
    "bag_repair": "het_ros.tools.bag_repair",
    "play": "het_ros.tools.play",
    "replay": "het_ros.tools.replay",
    "run": "het_ros.tools.run",
    "operator": "het_ros.operator.main",
    "closed_loop": "het_ros.tools.closed_loop",
    "scenes": "het_ros.tools.scenes",
    "two_hosts": "het_ros.tools.two_hosts",
    "evaluate": "het_ros.evaluation.cli",
    "bench": "het_ros.bench.cli",
    "faulty_camera": "het_ros.faults.camera",
    "one_host": "het_ros.faults.one_host",
    "overload": "het_ros.faults.overload",
    "stress": "het_ros.faults.stress",
    "soak": "het_ros.faults.soak",
}

# Packages by the module that is imported: how to install them on Ubuntu, and by pip.
PACKAGES = {
    "cv2": ("python3-opencv", "opencv-python-headless"),
    "numpy": ("python3-numpy", "numpy"),
    "filterpy": ("", "filterpy"),
    "tqdm": ("python3-tqdm", "tqdm"),
    "matplotlib": ("python3-matplotlib", "matplotlib"),
    "jinja2": ("python3-jinja2", "jinja2"),
    "joblib": ("python3-joblib", "joblib"),
    "yaml": ("python3-yaml", "pyyaml"),
    "rosbags": ("", "rosbags"),
    "av": ("python3-av", "av"),
    "threadpoolctl": ("python3-threadpoolctl", "threadpoolctl"),
    "aiohttp": ("python3-aiohttp", "aiohttp"),
    "jsonschema": ("python3-jsonschema", "jsonschema"),
    "segno": ("python3-segno", "segno"),
    "distributed": ("python3-distributed", "distributed"),
    "rclpy": ("ros-jazzy-rclpy", ""),
    "vision_msgs": ("ros-jazzy-vision-msgs", ""),
}


def __getattr__(name: str) -> Callable[[], int]:
    """The main function of a command, for the entry point ``het_ros.commands:NAME``."""
    if name not in COMMANDS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return partial(run_command, name)


def run_command(name: str) -> int:
    """Run a command with the process's arguments; 2 where a package of it is not installed."""
    from het_ros.ros.start import ended_by_ctrl_c  # setup.py reads the table without the package

    try:
        with ended_by_ctrl_c():
            module = import_module(COMMANDS[name])
        return int(module.main() or 0)
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in PACKAGES:
            raise
        print(f"{name}: {install_line(missing)}", file=sys.stderr)
        return 2


def install_line(module: str) -> str:
    """That a module is missing, and the command that installs it."""
    apt, pip = PACKAGES[module]
    if apt:
        way = f"sudo apt install {apt}" + (f" (or pip install {pip})" if pip else "")
    else:
        # PEP 668: pip on Ubuntu 24.04 refuses to touch the system's Python without the flag.
        way = f"python3 -m pip install --user --break-system-packages {pip}"
    return f"needs {module}, which is not installed: {way}"
