"""Footage for the tests of faults."""

from __future__ import annotations

import pytest

from het_ros.tools.footage import open_footage
from het_ros.tools.make_bag import make_bag


@pytest.fixture(scope="session")
def crossing_bag(sequences, tmp_path_factory):
    """A pedestrian on a crossing, 120 frames, with ground truth."""
    path = tmp_path_factory.mktemp("bags") / "crossing"
    make_bag(open_footage(sequences / "Crossing"), path)
    return path
