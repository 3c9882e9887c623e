# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The Fast DDS profile with which a publisher of images loses none on the way."""

from __future__ import annotations

import os
from pathlib import Path

PROFILE = "fastdds_shm.xml"
PLACES = (f"config/{PROFILE}", f"share/het_ros/config/{PROFILE}")  # checkout; colcon, pip, apt
SETTINGS = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")


def find_profile() -> Path:
    """The shipped profile, wherever the package is installed.

    Raises:
        FileNotFoundError: it was not installed with the package.
    """
    for parent in Path(__file__).resolve().parents:
        for place in PLACES:
            if (parent / place).is_file():
                return parent / place
    raise FileNotFoundError(f"{PROFILE} is missing: install the package again")


def use_profile() -> None:
    """Let this process publish with the shipped profile, unless the user chose another.

    Fast DDS reads it when the first participant is made: call this before ``rclpy.init``.
    """
    if not any(os.environ.get(name) for name in SETTINGS):
        os.environ[SETTINGS[0]] = str(find_profile())
