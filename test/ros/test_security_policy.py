# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The example policy for SROS 2 allows what the node does, and nothing that it does not."""

from pathlib import Path
from xml.etree import ElementTree

import pytest

from het_ros.ros.tracker_node import TrackerNode

POLICY = Path(__file__).parents[2] / "config" / "sros2_policy.xml"
# Not in every node: the other transport, simulated time, vision_msgs; and the log's topic where a
# node of the same name was in this process before (rcl keeps one publisher per name).
SOMETIMES = {"/image/compressed", "/clock", "/tracker/detections", "/detections_in", "/rosout"}


def allowed(kind: str) -> set[str]:
    """Full names of what one kind of access is given to."""
    names = ElementTree.parse(POLICY).findall(f".//*[@{kind}='ALLOW']/*")
    return {
        (text if text.startswith("/") else f"/{text}").replace("/~/", "/tracker/")
        for text in ((name.text or "") for name in names)
    }


@pytest.mark.parametrize(
    "kind, asked",
    [
        ("publish", "get_publisher_names_and_types_by_node"),
        ("subscribe", "get_subscriber_names_and_types_by_node"),
        ("reply", "get_service_names_and_types_by_node"),
    ],
)
def test_the_policy_is_the_node_s_own_graph(graph, kind, asked):
    node = graph.add(TrackerNode(context=graph.context))
    graph.spin_until(lambda: len(getattr(node, asked)("tracker", "/")) > 3, "the graph")
    graph.settle()
    assert {name for name, _ in getattr(node, asked)("tracker", "/")} - SOMETIMES == (
        allowed(kind) - SOMETIMES
    )


def test_it_calls_nobody_and_may_call_nobody(graph):
    node = graph.add(TrackerNode(context=graph.context))
    assert not node.get_client_names_and_types_by_node("tracker", "/")
    assert not allowed("request")
