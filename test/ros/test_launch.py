# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The launch files, as far as they can be tried where launch itself may not be installed."""

import importlib.util
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from het_ros import TrackerConfig
from het_ros.ros.parameters import NodeConfig
from het_ros.tracking.parameter import parameters_of

from .streams import Camera

ROOT = Path(__file__).parents[2]
XML = ElementTree.parse(ROOT / "launch" / "tracker.launch.xml").getroot()
INPUTS = {"image", "camera_info", "depth"}


def load_python():
    spec = importlib.util.spec_from_file_location(
        "tracker_launch", ROOT / "launch" / "tracker.launch.py"
    )
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def stand_in(name: str, **contents) -> ModuleType:
    module = ModuleType(name)
    vars(module).update(contents)
    return module


@pytest.fixture
def without_launch(monkeypatch):
    """Modules that only keep what they are given, where launch is not installed."""

    def keeper(kind):
        return lambda *args, **kwargs: SimpleNamespace(kind=kind, args=args, **kwargs)

    kinds = {
        "launch": ["LaunchDescription"],
        "launch.conditions": ["IfCondition"],
        "launch.actions": ["DeclareLaunchArgument"],
        "launch.substitutions": ["LaunchConfiguration", "PathJoinSubstitution"],
        "launch_ros": [],
        "launch_ros.actions": ["Node"],
        "launch_ros.substitutions": ["FindPackageShare"],
    }
    for name, members in kinds.items():
        module = stand_in(name, **{member: keeper(member) for member in members})
        monkeypatch.setitem(sys.modules, name, module)


def test_the_python_file_loads_where_launch_is_installed():
    pytest.importorskip("launch_ros", reason="launch is not on PyPI: apt's ROS has it")
    assert load_python().generate_launch_description().entities


def test_both_files_say_the_same(without_launch):
    (entities,) = load_python().generate_launch_description().args
    *arguments, node, page = entities
    in_python = {a.args[0]: (a.default_value, a.description) for a in arguments}
    in_xml = {a.get("name"): (a.get("default"), a.get("description")) for a in XML.iter("arg")}
    assert in_python.pop("params_file")[0].args[0][1:] == ["config", "tracker.yaml"]
    assert in_xml.pop("params_file")[0] == "$(find-pkg-share het_ros)/config/tracker.yaml"
    assert in_python.pop("targets")[0].args[0] == inner(in_xml.pop("targets")[0]) == "name"
    assert in_python == in_xml

    for made, element in zip((node, page), XML.iter("node"), strict=True):
        assert (made.package, made.executable) == (element.get("pkg"), element.get("exec"))
        remaps = {source: target.args[0] for source, target in vars(made).get("remappings", ())}
        assert remaps == {r.get("from"): inner(r.get("to")) for r in element.iter("remap")}
        set_here = {
            p.get("name"): inner(p.get("value")) for p in element.iter("param") if p.get("name")
        }
        assert {name: value.args[0] for name, value in made.parameters[-1].items()} == set_here
    element = XML.find("node")
    first, second = node.arguments
    assert element.get("args") == f"{first} $(var {second.args[0]})" == "--targets $(var targets)"
    assert element.get("name") is None and not hasattr(node, "name")  # it renames all targets
    assert page.condition.args[0].args[0] == inner(XML.findall("node")[1].get("if"))


def inner(text: str) -> str:
    return re.fullmatch(r"\$\(var (\w+)\)", text)[1]


def test_what_they_name_is_there():
    node = XML.find("node")
    assert {r.get("from") for r in node.iter("remap")} == INPUTS
    known = {p.name for table in (NodeConfig, TrackerConfig) for p in parameters_of(table)}
    named = {p.get("name") for p in node.iter("param") if p.get("name")}
    assert named <= known | {"use_sim_time"}
    declared = {a.get("name") for a in XML.iter("arg")}
    assert set(re.findall(r"\$\(var (\w+)\)", ElementTree.tostring(XML, "unicode"))) == declared


def test_package_xml_lists_what_they_need():
    package = ElementTree.parse(ROOT / "package.xml").getroot()
    needed = {element.text for element in package.iter("exec_depend")}
    assert {"launch", "launch_ros", "launch_xml"} <= needed


@pytest.mark.parametrize("targets", ["tracker", "left,right"])
def test_the_node_starts_with_what_they_pass(processes, local_graph, targets):
    """The command line that launch makes of the XML, with the defaults and a namespace."""
    values = {a.get("name"): a.get("default") for a in XML.iter("arg")} | {"targets": targets}
    values |= {"namespace": "robot1", "params_file": str(ROOT / "config" / "tracker.yaml")}
    node = XML.find("node")
    command = ["--targets", values[inner(node.get("args").split(" ", 1)[1])], "--ros-args"]
    command += ["-r", f"__ns:=/{values['namespace']}", "--params-file", values["params_file"]]
    for remap in node.iter("remap"):
        command += ["-r", f"{remap.get('from')}:={values[inner(remap.get('to'))]}"]
    for param in node.iter("param"):
        if param.get("name"):
            command += ["-p", f"{param.get('name')}:={values[inner(param.get('value'))]}"]
    processes("tracker", *command)
    remaps = ["--ros-args", "-r", "__ns:=/robot1", "-r", "image:=/camera/image_raw"]
    camera = local_graph.add(Camera(context=local_graph.context, cli_args=remaps))
    local_graph.spin_until(
        lambda: camera.images.get_subscription_count() > 0, "the node on the camera's topic"
    )
    local_graph.spin_until(
        lambda: (
            {(name, "/robot1") for name in targets.split(",")}
            <= set(camera.get_node_names_and_namespaces())
        ),
        "its name",
    )
