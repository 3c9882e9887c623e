# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Settings of all fuzzing: short and repeatable in CI, long and random under `make fuzz`.

Of each test there is one environment variable more than pytest gives: ``HET_FUZZ_CASES``, how many
cases to try; :mod:`fuzz.campaign` sets it, with ``HET_FUZZ_FOUND``, where what fails is kept, and
``HET_FUZZ_COUNT``, the file that the number of cases tried is written to.
"""

import json
import os
from pathlib import Path

import cv2
import hypothesis
import pytest
from hypothesis.database import DirectoryBasedExampleDatabase

from .cases import COUNTS

LONG = "HET_FUZZ_CASES" in os.environ
FOUND = os.environ.get("HET_FUZZ_FOUND")

hypothesis.settings.register_profile(
    "fuzz",
    deadline=None,
    derandomize=not LONG,  # what CI tries is the same in every run
    database=DirectoryBasedExampleDatabase(FOUND) if FOUND else None,
    print_blob=True,
    phases=[phase for phase in hypothesis.Phase if phase is not hypothesis.Phase.explain],
    suppress_health_check=list(hypothesis.HealthCheck),
)


@pytest.fixture(autouse=True)
def by_itself(monkeypatch, tmp_path_factory):
    """No other process hears the nodes, and nothing but temporary folders is written."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path_factory.getbasetemp() / "log"))
    cv2.setNumThreads(1)


def pytest_sessionfinish():
    file = os.environ.get("HET_FUZZ_COUNT")
    if file:
        Path(file).write_text(json.dumps(COUNTS))
