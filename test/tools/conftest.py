# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bags for the tests of the tools."""

from __future__ import annotations

import dataclasses

import pytest

from het_ros.tools.footage import Footage, open_footage
from het_ros.tools.make_bag import make_bag

FRAMES = 40


def shortened(footage: Footage, frames: int) -> Footage:
    return dataclasses.replace(
        footage, images=footage.images[:frames], frames=frames, truth=footage.truth[:frames]
    )


@pytest.fixture(scope="session")
def crossing(sequences) -> Footage:
    """The first 40 frames of a pedestrian on a crossing, with ground truth."""
    return shortened(open_footage(sequences / "Crossing"), FRAMES)


@pytest.fixture(scope="session")
def crossing_bag(crossing, tmp_path_factory):
    path = tmp_path_factory.mktemp("bags") / "crossing"
    make_bag(crossing, path)
    return path


@pytest.fixture(scope="session")
def short_bag(crossing, tmp_path_factory):
    """The first 16 frames, for what does not need more."""
    path = tmp_path_factory.mktemp("bags") / "short"
    make_bag(shortened(crossing, 16), path)
    return path


@pytest.fixture(autouse=True)
def taken_back(own_environment):
    """The tools choose a ROS domain and a profile for their process."""
