# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The cable between camera and tracker is pulled for five seconds."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest
from graph import PATIENCE

from het_ros.tools.two_hosts import namespaces


@pytest.fixture
def two_hosts(installed):
    if os.geteuid() != 0:
        pytest.skip("network namespaces take root")
    try:
        with namespaces():
            yield
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f"no network namespaces here: {error}")


@pytest.mark.slow
def test_a_network_that_is_cut_and_mended(two_hosts):
    """Silence while it is cut, then LOST with the length of the gap, then a box and it tracks."""
    ended = subprocess.run(
        [sys.executable, "-m", "het_ros.faults.cable", "--seconds", "5", "--inside"],
        stdout=subprocess.PIPE,
        timeout=5 * PATIENCE,
    )
    assert ended.returncode == 0
    told = json.loads(ended.stdout)
    assert told["before"]["TRACKING"] > 0
    assert told["answered_while_cut"] == 0
    assert told["first_after"]["state"] == "LOST"
    assert "no image for" in told["first_after"]["reason"]
    assert told["after_a_box"]["TRACKING"] > 0
    assert told["tracker_alive"]
