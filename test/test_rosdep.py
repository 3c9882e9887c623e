# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The README's commands for a fresh Ubuntu 24.04, as far as rosdep simulates them."""

import os
import re
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

pytest.importorskip("rosdep2", reason="rosdep is not installed")
ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
(COMMAND,) = re.findall(r"^rosdep install .*$", README, re.MULTILINE)
# What the keys stand for on Ubuntu; those of ROS packages are ros-jazzy-NAME.
PIP_KEY = "python3-filterpy-pip"
INDEX = """%YAML 1.1
---
distributions:
  jazzy:
    distribution: [jazzy.yaml]
    distribution_cache: cache.yaml
    distribution_status: active
    distribution_type: ros2
    python_version: 3
type: index
version: 4
"""
DISTRIBUTION = """%YAML 1.1
---
release_platforms: {ubuntu: [noble]}
repositories: {}
type: distribution
version: 2
"""
CACHE = """%YAML 1.1
---
distribution_file:
- release_platforms: {ubuntu: [noble]}
  repositories: {}
  type: distribution
  version: 2
name: jazzy
release_package_xmls: {}
type: cache
version: 2
"""


def declared() -> set[str]:
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    return {e.text for kind in ("exec_depend", "test_depend") for e in package.iter(kind)}


def rule(key: str) -> str:
    if key == PIP_KEY:
        return f"{key}: {{ubuntu: {{pip: {{packages: [filterpy]}}}}}}"
    apt = key if key.startswith("python3-") else f"ros-jazzy-{key.replace('_', '-')}"
    return f"{key}: {{ubuntu: [{apt}]}}"


@pytest.fixture
def workspace(tmp_path):
    """A workspace with this package, and rosdep's environment with the keys that it uses."""
    sources, src = tmp_path / "sources", tmp_path / "src" / "het_ros"
    sources.mkdir()
    src.mkdir(parents=True)
    (src / "package.xml").write_text((ROOT / "package.xml").read_text())
    (tmp_path / "keys.yaml").write_text("\n".join(map(rule, sorted(declared()))) + "\n")
    (sources / "20-default.list").write_text(f"yaml file://{tmp_path}/keys.yaml\n")
    for name, text in (("index", INDEX), ("jazzy", DISTRIBUTION), ("cache", CACHE)):
        (tmp_path / f"{name}.yaml").write_text(text)
    environment = {
        **os.environ,
        "HOME": str(tmp_path),
        "ROSDEP_SOURCE_PATH": str(sources),
        "ROSDISTRO_INDEX_URL": f"file://{tmp_path}/index.yaml",
        "ROS_DISTRO": "jazzy",
        "ROS_PYTHON_VERSION": "3",
        "AMENT_PREFIX_PATH": str(tmp_path),  # nothing is installed there
    }
    subprocess.run(
        ["rosdep", "update", "--rosdistro", "jazzy"],
        env=environment,
        check=True,
        capture_output=True,
    )
    return tmp_path, environment


def test_rosdep_installs_all_but_what_ubuntu_has_not(workspace):
    folder, environment = workspace
    ended = subprocess.run(
        [*COMMAND.split(), "--os", "ubuntu:noble", "--simulate", "--reinstall"],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    installed = set(re.findall(r"apt-get .*install.* (\S+)$", ended.stdout, re.MULTILINE))
    expected = {re.search(r"\[(.*?)\]", rule(key))[1] for key in declared() - {PIP_KEY}}
    assert installed == expected
    assert "pip" not in ended.stdout.replace("python3-pip", "")


def test_what_rosdep_leaves_out_is_installed_by_the_next_line():
    """PEP 668: pip refuses without the flag, and sudo drops a variable that would allow it."""
    assert f"--skip-keys {PIP_KEY}" in COMMAND
    after = README.split(COMMAND)[1].strip().splitlines()[0]
    assert after.startswith(
        "python3 -m pip install --user --break-system-packages --no-deps filterpy"
    )
    assert PIP_KEY in declared()  # the key stays: it is a dependency
    # Without --no-deps pip would bring a NumPy of its own beside apt's.
    assert {"python3-numpy", "python3-scipy", "python3-matplotlib"} <= declared()
