# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import argparse

import pytest

from het_ros.operator import demo
from het_ros.tools import run
from het_ros.tools.arguments import add_network


def parsed(given):
    parser = argparse.ArgumentParser()
    add_network(parser)
    return parser.parse_args(given).network


def test_a_networks_folder_is_absolute_and_may_be_left_out(made_network, monkeypatch):
    monkeypatch.chdir(made_network.parent)
    assert parsed(["--network", made_network.name]) == str(made_network)
    assert parsed([]) == parsed(["--network", ""]) == ""


def test_a_folder_without_a_network_is_refused_in_one_line(tmp_path, capsys):
    with pytest.raises(SystemExit):
        parsed(["--network", str(tmp_path)])
    said = capsys.readouterr().err.splitlines()[-1]
    assert f"argument --network: {tmp_path} needs one NanoTrack network" in said


@pytest.mark.parametrize("command", [run, demo])
def test_it_is_a_parameter_of_the_tracker_that_is_started(command, made_network):
    options = command._parse(["-p", "seed:=3", "--network", str(made_network)])
    assert options.parameters == ["seed:=3", f"network:={made_network}"]
    assert command._parse([]).parameters == []
