# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Footage for the tests of faults."""

from __future__ import annotations

import os

import pytest
from graph import EXECUTABLES, Graph

from het_ros.tools.footage import open_footage
from het_ros.tools.make_bag import make_bag
from het_ros.tools.tracker_process import TrackerProcess, free_domain

from .lockstep import TRACKER, LockStep, crossing


@pytest.fixture(scope="session")
def crossing_bag(sequences, tmp_path_factory):
    """A pedestrian on a crossing, 120 frames, with ground truth."""
    path = tmp_path_factory.mktemp("bags") / "crossing"
    make_bag(open_footage(sequences / "Crossing"), path)
    return path


@pytest.fixture(scope="module")
def tracker_of_the_module(installed, tmp_path_factory):
    """``tracker_of_the_module(*arguments)``: one installed tracker for all tests of a file.

    Gives a :class:`Graph` that sees it and its log; at the end it must still run.
    """
    log = tmp_path_factory.mktemp("tracker") / "log.txt"
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        patch.setitem(os.environ, "ROS_DOMAIN_ID", str(free_domain()))
        patch.setitem(os.environ, "ROS_LOG_DIR", str(log.parent))
        opened = []

        def start(*arguments: str):
            opened.append(TrackerProcess(EXECUTABLES / "tracker", arguments, log))
            opened.append(Graph())
            return opened[1], log

        start.pid = lambda: opened[0].pid
        yield start
        if opened:
            tracker, graph = opened
            graph.close()
            with tracker:
                tracker.check()
            assert "Traceback" not in log.read_text()


@pytest.fixture(scope="module")
def connected(tracker_of_the_module, sequences):
    """A :class:`LockStep` with the tracker of a file; ``log`` and ``pid`` are the tracker's."""
    graph, log = tracker_of_the_module(*TRACKER)
    made = LockStep.connect(graph, crossing(sequences))
    made.log, made.pid = log, tracker_of_the_module.pid()
    return made


@pytest.fixture
def lockstep(connected):
    """The file's :class:`LockStep`, at the beginning of a stream."""
    connected.begin()
    return connected
