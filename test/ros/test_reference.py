# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

import yaml

from het_ros import TrackerConfig
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.reference import parameters_file, parameters_page
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tracking.parameter import parameters_of

ROOT = Path(__file__).parents[2]
STALE = "stale: run `make docs` and commit what it writes"


def test_docs_are_in_step_with_the_tables():
    assert (ROOT / "docs" / "PARAMETERS.md").read_text() == parameters_page(), STALE


def test_config_is_in_step_with_the_tables():
    assert (ROOT / "config" / "tracker.yaml").read_text() == parameters_file(), STALE


def test_config_holds_every_default():
    values = yaml.safe_load(parameters_file())["/**"]["ros__parameters"]
    for table in (NodeConfig, TrackerConfig):
        for declared in parameters_of(table):
            default = declared.default
            wanted = list(default) if isinstance(default, tuple) else default
            assert values.pop(declared.name) == wanted
            assert type(wanted) in (bool, int, float, str, list)
    assert not values


def test_a_node_starts_with_the_config(graph):
    file = str(ROOT / "config" / "tracker.yaml")
    node = graph.add(
        TrackerNode(context=graph.context, cli_args=["--ros-args", "--params-file", file])
    )
    assert node.get_parameter("max_gap").value == NodeConfig().max_gap
