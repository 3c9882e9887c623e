# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``colcon test`` where only what rosdep installs is there: it runs what can run."""

import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parents[1]
MISSING = ("hypothesis", "rosbags", "av", "joblib", "distributed", "tqdm", "threadpoolctl")
PLUGIN = f"""
import sys

class Missing:
    def find_spec(name, path=None, target=None):
        if name.partition(".")[0] in {MISSING!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Missing)
"""


def test_what_cannot_run_is_skipped_by_name(tmp_path):
    (tmp_path / "without.py").write_text(PLUGIN)
    plugins = ("-p", "without", "-p", "no:hypothesispytest", "-p", "no:cacheprovider")
    paths = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    ended = subprocess.run(
        [sys.executable, "-m", "pytest", *plugins, "--collect-only", "-q"],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stdout[-3000:] + ended.stderr[-3000:]
    assert "test/ros/test_tracker_node.py::test_real_footage" in ended.stdout
    for file, missing in (
        ("test/ros/test_images.py", "hypothesis"),
        ("test/fuzz", "hypothesis"),
        ("test/tools:", "tqdm"),
    ):
        assert any(
            file in line and f"needs {missing}, which is not installed" in line
            for line in ended.stdout.splitlines()
        ), file


def test_test_dependencies_are_declared():
    declared = {e.text for e in ElementTree.parse(ROOT / "package.xml").iter("test_depend")}
    assert {"python3-pytest", "python3-hypothesis", "python3-catkin-pkg-modules"} <= declared
