# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What tests of several packages share: real footage, made footage, a graph of nodes, a process.

ROS is imported where it is used only, so that the core's tests run without it.
"""

from __future__ import annotations

import itertools
import os
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from graph import EXECUTABLES, PATIENCE, ROOT, Graph
from moving_target import FIRST_BOX, moving_target

try:
    import hypothesis
except ModuleNotFoundError:  # tests that need it are skipped
    pass
else:
    # A busy machine is no failure: no limit of time for an example.
    hypothesis.settings.register_profile("patient", deadline=None)
    hypothesis.settings.load_profile("patient")

# What a machine with apt's ROS may be without: tests that need one of these are skipped by name.
OPTIONAL = {
    *("av", "distributed", "hypothesis", "jinja2", "joblib", "matplotlib", "onnx", "rclpy"),
    *("rosbags", "threadpoolctl", "tqdm", "yaml"),
}

# The Clip of NanoTrack's heads has its limits as inputs, which older ones do not know.
READS_NETWORKS = tuple(map(int, cv2.__version__.split(".")[:2])) >= (4, 7)

# Fast DDS reads it once a process: it must be set before the first node.
os.environ.setdefault("FASTRTPS_DEFAULT_PROFILES_FILE", str(ROOT / "config" / "fastdds_shm.xml"))


class SkipWhatIsMissing:
    """Skips a file or folder that imports what is not installed, and says what that is."""

    @pytest.hookimpl(hookwrapper=True)
    def pytest_make_collect_report(self):
        outcome = yield
        report = outcome.get_result()
        missing = re.search(r"ModuleNotFoundError: No module named '(\w+)", str(report.longrepr))
        if report.failed and missing and missing[1] in OPTIONAL:
            report.outcome = "skipped"
            reason = f"Skipped: needs {missing[1]}, which is not installed"
            report.longrepr = (report.nodeid, 0, reason)


def pytest_configure(config):
    # A conftest's own hooks are not called for folders whose conftest fails.
    config.pluginmanager.register(SkipWhatIsMissing())


@pytest.fixture(scope="session")
def sequences() -> Path:
    """The folder of real sequences, $HET_SEQUENCES; tests that need it are skipped without."""
    folder = Path(os.environ.get("HET_SEQUENCES", ROOT.parent / "shared" / "sequences"))
    if not any(folder.glob("*/groundtruth_rect*.txt")):
        pytest.skip(f"no real sequences in {folder}: set HET_SEQUENCES to their folder")
    return folder


@pytest.fixture(scope="session")
def models() -> Path:
    """The folder of networks, $HET_MODELS; without it tests of them are skipped, but not in CI."""
    folder = Path(os.environ.get("HET_MODELS", ROOT.parent / "shared" / "models"))
    if not any(folder.glob("nanotrack*/*.onnx")):
        missing = f"no networks in {folder}: set HET_MODELS to their folder"
        pytest.fail(missing) if os.environ.get("CI") else pytest.skip(missing)
    if not READS_NETWORKS:
        pytest.skip(f"OpenCV {cv2.__version__} cannot read them: 4.7 can")
    return folder


@pytest.fixture(scope="session")
def made_network(tmp_path_factory) -> Path:
    """The folder of a tiny network with the inputs and outputs of NanoTrack v3."""
    pytest.importorskip("onnx", reason="onnx, which writes the network, is not installed")
    if not READS_NETWORKS:
        pytest.skip(f"OpenCV {cv2.__version__} cannot read it: 4.7 can")
    from made_network import write_network

    return write_network(tmp_path_factory.mktemp("models") / "nanotrackv3")


@pytest.fixture(scope="session")
def made_footage() -> tuple[list[np.ndarray], tuple[float, float, float, float]]:
    """40 frames of the moving target; its first box."""
    return moving_target(40), FIRST_BOX


@pytest.fixture
def graph(monkeypatch, tmp_path):
    """A :class:`Graph` of its own."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    made = Graph()
    yield made
    made.close()


@pytest.fixture
def local_graph(processes):
    """A :class:`Graph` that sees what ``processes`` started."""
    made = Graph()
    yield made
    made.close()


@pytest.fixture(scope="session")
def installed() -> None:
    """For tests that start what is installed; they are skipped where nothing is."""
    if not (EXECUTABLES / "tracker").exists():
        pytest.skip("nothing installed: run `make build`, and source install/setup.bash")


@pytest.fixture
def own_environment():
    """For tests of what chooses a ROS domain for its process: that is taken back."""
    before = dict(os.environ)
    yield
    os.environ.clear()
    os.environ.update(before)


_domains = itertools.count(20 + os.getpid() % 150)


@pytest.fixture
def processes(installed, monkeypatch, tmp_path):
    """Start installed executables: ``processes("tracker", "--ros-args", ...)`` gives the Popen.

    They and the test's own process share a ROS domain that nobody else uses. What still runs at
    the end is told to stop (SIGTERM), and killed if it does not. Output goes to a file,
    ``process.log``.
    """
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(next(_domains)))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    started: list[subprocess.Popen] = []

    def start(executable: str, *arguments: str) -> subprocess.Popen:
        log = tmp_path / f"{executable}-{len(started)}.txt"
        with log.open("w") as output:
            process = subprocess.Popen(
                [str(EXECUTABLES / executable), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        process.log = log
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.terminate()
    for process in started:
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            print(f"had to be killed: {process.args}", file=sys.stderr)
