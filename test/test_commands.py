# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executables: their names, their help, and what they say where a package is missing."""

import re
import runpy
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import pytest
from graph import EXECUTABLES

from het_ros.commands import COMMANDS, PACKAGES, install_line

ROOT = Path(__file__).parents[1]
DECLARED = {e.text for e in ElementTree.parse(ROOT / "package.xml").iter("exec_depend")}
# No key in rosdep: asked for when they are missed. BLAS's threads are limited, and the operator's
# address is drawn as a QR code, where theirs is there.
WITHOUT_KEY = {"rosbags", "av", "threadpoolctl", "distributed", "segno"}
WITHOUT = """
import sys

class Missing:
    def find_spec(name, path=None, target=None):
        if name.partition(".")[0] in {names!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Missing)
sys.argv = [{command!r}]
"""


def without(names, command, code):
    """Run code in a Python that has not got some packages."""
    return subprocess.run(
        [sys.executable, "-c", WITHOUT.format(names=set(names), command=command) + code],
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_an_example_that_ros2_runs(name, capsys):
    pytest.importorskip("rclpy")
    with pytest.raises(SystemExit) as ended:
        import_module(COMMANDS[name]).main(["--help"])
    assert ended.value.code == 0
    assert f"ros2 run het_ros {name}" in capsys.readouterr().out


@pytest.mark.parametrize(
    "page", ["README.md", "bags/README.md", *map(str, ROOT.glob("docs/*.md"))]
)
def test_documents_name_executables(page):
    """Stock Ubuntu has no ``python``, and ``ros2 run`` needs no module's name."""
    assert not re.search(r"\bpython3? -m het_ros", (ROOT / page).read_text())


def test_what_colcon_installed_is_the_table(installed):
    assert {path.name for path in EXECUTABLES.iterdir()} == set(COMMANDS)


@pytest.mark.parametrize(
    "words, prefix",
    [
        (["install", "--prefix", "x"], ""),
        (["develop", "--editable"], ""),
        (["bdist_wheel"], "het_ros_"),
        (["editable_wheel"], "het_ros_"),
    ],
)
def test_names_carry_a_prefix_on_the_path_of_a_pip_user(monkeypatch, words, prefix):
    setuptools = pytest.importorskip("setuptools")
    given = {}
    monkeypatch.setattr(setuptools, "setup", lambda **options: given.update(options))
    monkeypatch.setattr(sys, "argv", ["setup.py", *words])
    runpy.run_path(str(ROOT / "setup.py"))
    scripts = given["entry_points"]["console_scripts"]
    assert scripts == [f"{prefix}{name} = het_ros.commands:{name}" for name in COMMANDS]


@pytest.mark.parametrize(
    "missing, command, way",
    [
        ("rosbags", "play", "python3 -m pip install --user --break-system-packages rosbags"),
        ("av", "run", "sudo apt install python3-av"),
        ("tqdm", "make_bag", "sudo apt install python3-tqdm"),
        ("joblib", "evaluate", "sudo apt install python3-joblib"),
        ("cv2", "tracker", "sudo apt install python3-opencv"),
        ("aiohttp", "operator", "sudo apt install python3-aiohttp"),
        ("jsonschema", "operator", "sudo apt install python3-jsonschema"),
    ],
)
def test_a_missing_package_is_one_line_with_the_command_that_installs_it(missing, command, way):
    ended = without(
        [missing], command, f"from het_ros.commands import {command}; exit({command}())"
    )
    assert ended.returncode == 2
    (line,) = ended.stderr.splitlines()
    assert line.startswith(f"{command}: needs {missing}, which is not installed: ")
    assert way in line


def test_the_node_imports_nothing_of_the_tools():
    tools = ["tqdm", "rosbags", "av", "jinja2", "joblib", "hypothesis", "distributed"]
    for module in ("het_ros.ros.tracker_node", "het_ros.ros.follower_example"):
        ended = without(tools, "tracker", f"import {module}")
        assert ended.returncode == 0, ended.stderr


def test_without_the_operator_s_packages_all_else_runs():
    others = sorted({module for name, module in COMMANDS.items() if name != "operator"})
    ended = without(["aiohttp", "jsonschema", "segno"], "tracker", f"import {', '.join(others)}")
    assert ended.returncode == 0, ended.stderr


def test_package_xml_declares_what_rosdep_has():
    keys = {
        "filterpy": "python3-filterpy-pip",
        "rclpy": "rclpy",
        "vision_msgs": "vision_msgs",
    }
    for module, (apt, _) in PACKAGES.items():
        if module not in WITHOUT_KEY:
            assert keys.get(module, apt) in DECLARED, module


@pytest.mark.parametrize("module", PACKAGES)
def test_each_package_has_a_way(module):
    assert re.search(r": (sudo apt install|python3 -m pip install) \S", install_line(module))


def test_launch_is_declared_with_its_command():
    assert {"ros2launch", "launch", "launch_ros", "launch_xml"} <= DECLARED
