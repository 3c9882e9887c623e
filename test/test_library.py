# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The package as pip installs it: what it says of itself, what it needs, what it exports."""

import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from xml.etree import ElementTree

import pytest

import het_ros

ROOT = Path(__file__).parents[1]
PACKAGE = ElementTree.parse(ROOT / "package.xml").getroot()
EXAMPLE = re.search(
    r"As a library.*?```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL
)[1]
RUN = f"""
import numpy as np
image = np.random.default_rng(0).integers(0, 255, (240, 320, 3), np.uint8)
{EXAMPLE}
assert estimate.state.value in ("TRACKING", "COASTING"), estimate
from het_ros import Estimate, Patch, State, Witness, __version__
print(__version__)
"""
ONLY = """
import sys

class Only:
    def find_spec(name, path=None, target=None):
        top = name.partition(".")[0]
        if top in {others!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Only)
"""


def installed_with(requirement: str) -> set[str]:
    """Names of the distributions that pip installs for a requirement, itself among them."""
    packaging = pytest.importorskip("packaging.requirements")
    found, todo = set(), [packaging.Requirement(requirement)]
    while todo:
        wanted = todo.pop()
        name = plain(wanted.name)
        if (name, *sorted(wanted.extras)) in found:
            continue
        found.add((name, *sorted(wanted.extras)))
        for line in metadata.requires(wanted.name) or []:
            needed = packaging.Requirement(line)
            extras = wanted.extras or {""}
            if not needed.marker or any(needed.marker.evaluate({"extra": e}) for e in extras):
                todo.append(needed)
    return {name for name, *_ in found}


def plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_the_library_needs_nothing_but_what_pip_installs_with_it():
    """The README's example, in a Python that has got only what het_ros[opencv] asks for."""
    allowed = installed_with("het_ros[opencv]")
    assert {"numpy", "filterpy", "opencv-python-headless"} <= allowed
    others = {
        module
        for module, owners in metadata.packages_distributions().items()
        if not {plain(owner) for owner in owners} & allowed
    }
    assert {"rclpy", "pytest", "tqdm"} <= others
    ended = subprocess.run(
        [sys.executable, "-c", ONLY.format(others=others) + RUN],
        capture_output=True,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.strip() == PACKAGE.findtext("version")


@pytest.mark.slow
def test_the_library_in_an_empty_environment(tmp_path):
    """The same with a venv of its own, from the package index."""
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "venv"], check=True)
    python = tmp_path / "venv" / "bin" / "python"
    clean = {"PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}
    subprocess.run([python, "-m", "pip", "install", "-q", f"{ROOT}[opencv]"], check=True)
    ended = subprocess.run(
        [python, "-c", RUN], cwd=tmp_path, env=clean, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr
    names = {path.name for path in (tmp_path / "venv" / "bin").iterdir()}
    assert "het_ros_play" in names and not {"play", "run", "evaluate", "tracker"} & names


def test_without_opencv_the_first_use_says_what_to_install():
    code = ONLY.format(others={"cv2"}) + "from het_ros import HierarchicalEnsembleTracker"
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert "pip install 'het_ros[opencv]'" in ended.stderr.splitlines()[-1]


def test_metadata_are_those_of_package_xml():
    assert het_ros.__version__ == PACKAGE.findtext("version")
    said = metadata.metadata("het_ros")
    assert said["Summary"] == " ".join(PACKAGE.findtext("description").split())
    assert said["Maintainer-email"] == PACKAGE.find("maintainer").get("email")
    assert {u.get("type") for u in PACKAGE.findall("url")} == {
        "website",
        "repository",
        "bugtracker",
    }
    assert PACKAGE.findtext("version") not in (ROOT / "setup.py").read_text()


@pytest.mark.parametrize("name", het_ros.__all__)
def test_what_is_public_is_there(name):
    assert getattr(het_ros, name) is not None


def test_pip_knows_how_to_build_it():
    assert '[build-system]\nrequires = ["setuptools' in (ROOT / "pyproject.toml").read_text()


def test_the_changelog_is_one_for_catkin(tmp_path):
    """What ``catkin_prepare_release`` makes of it is what bloom reads."""
    changelog = pytest.importorskip("catkin_pkg.changelog")
    version = pytest.importorskip("catkin_pkg.package_version")
    file = tmp_path / "CHANGELOG.rst"
    file.write_text((ROOT / "CHANGELOG.rst").read_text())
    read = changelog.get_changelog_from_path(str(tmp_path))
    version.update_changelog_sections({"het_ros": (str(file), read, "Forthcoming")}, "9.8.7")
    assert "9.8.7" in file.read_text()
    released = changelog.get_changelog_from_path(str(tmp_path))
    ((number, _, entries),) = released.foreach_version()
    assert number == "9.8.7" and entries
