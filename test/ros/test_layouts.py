# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The viewers' layouts name topics that there are."""

import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import yaml

from het_ros.ros.outputs import OUTPUTS

CONFIG = Path(__file__).parents[2] / "config"


@pytest.mark.parametrize("name", ["tracker.rviz", "foxglove.json"])
def test_layouts_read_and_name_topics_of_the_node(name):
    text = (CONFIG / name).read_text()
    assert yaml.safe_load(text) if name.endswith("rviz") else json.loads(text)
    topics = set(re.findall(r"/tracker/(\w+)", text))
    assert topics
    assert topics <= set(OUTPUTS)


def test_every_foxglove_panel_is_laid_out():
    layout = json.loads((CONFIG / "foxglove.json").read_text())
    placed = re.findall(r'"(\w+!\w+)"', json.dumps(layout["layout"]))
    assert sorted(placed) == sorted(layout["configById"])


def test_fast_dds_profile():
    """One default participant whose transports are those described, with room for 4K frames."""
    name = "{http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles}"
    root = ElementTree.parse(CONFIG / "fastdds_shm.xml").getroot()
    described = {
        d.find(f"{name}transport_id").text for d in root.iter(f"{name}transport_descriptor")
    }
    (participant,) = root.iter(f"{name}participant")
    assert participant.get("is_default_profile") == "true"
    used = participant.find(f"{name}rtps/{name}userTransports")
    assert {t.text for t in used} == described
    (segment,) = root.iter(f"{name}segment_size")
    assert int(segment.text) > 3840 * 2160 * 3
