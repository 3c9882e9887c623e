# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest
from rcl_interfaces.msg import ParameterType
from rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
)
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter
from rclpy.parameter_client import AsyncParameterClient

from het_ros import TrackerConfig
from het_ros.ros.parameters import NodeConfig, declare, read
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tracking.parameter import parameters_of

from .streams import ByHand, header_at, image_message

TABLES = (TrackerConfig, NodeConfig)
DECLARED = [(table, declared) for table in TABLES for declared in parameters_of(table)]
ROS_TYPES = {
    bool: ParameterType.PARAMETER_BOOL,
    int: ParameterType.PARAMETER_INTEGER,
    float: ParameterType.PARAMETER_DOUBLE,
    str: ParameterType.PARAMETER_STRING,
    tuple: ParameterType.PARAMETER_STRING_ARRAY,
}


def node_with(graph, **overrides) -> Node:
    node = Node(
        "declared",
        context=graph.context,
        parameter_overrides=[RosParameter(name, value=v) for name, v in overrides.items()],
    )
    graph.add(node)
    declare(node, TrackerConfig())
    declare(node, NodeConfig())
    return node


def test_no_name_stands_in_both_tables():
    names = [declared.name for _, declared in DECLARED]
    assert len(names) == len(set(names))


def test_every_parameter_is_declared_as_the_table_says(graph):
    node = node_with(graph)
    for table, declared in DECLARED:
        descriptor = node.describe_parameter(declared.name)
        assert descriptor.type == ROS_TYPES[type(declared.default)], declared.name
        assert descriptor.description.startswith(declared.doc)
        assert declared.unit in descriptor.description
        assert descriptor.read_only == declared.read_only
        ranges = [*descriptor.integer_range, *descriptor.floating_point_range]
        assert bool(ranges) == (declared.low is not None or declared.high is not None)
        for limits in ranges:
            assert declared.low is None or limits.from_value == declared.low
            assert declared.high is None or limits.to_value == declared.high
        assert read(node, table) == table()


def test_overrides_are_read(graph):
    node = node_with(graph, seed=42, max_gap=3.5, image_transport="compressed")
    assert read(node, TrackerConfig).seed == 42
    assert read(node, NodeConfig).max_gap == 3.5
    assert read(node, NodeConfig).image_transport == "compressed"


@pytest.mark.parametrize(
    "overrides, error",
    [
        ({"max_gap": -1.0}, InvalidParameterValueException),
        ({"seed": -1}, InvalidParameterValueException),
        ({"seed": "seven"}, InvalidParameterTypeException),
        ({"max_gap": 5}, InvalidParameterTypeException),
    ],
)
def test_overrides_outside_type_or_range_are_refused(graph, overrides, error):
    with pytest.raises(error, match=next(iter(overrides))):
        node_with(graph, **overrides)


def test_a_choice_that_there_is_not_is_refused_when_read(graph):
    with pytest.raises(ValueError, match="raw, compressed"):
        read(node_with(graph, image_transport="smoke"), NodeConfig)


@pytest.fixture
def hand(graph, made_footage):
    frames, box = made_footage
    hand = ByHand(graph)
    hand.image(frames[0], 1.0)
    hand.box(box)
    return hand


@pytest.mark.parametrize(
    "name, value, says",
    [
        ("max_gap", -1.0, "max_gap"),
        ("max_gap", "long", "type"),
        ("seed", -5, "seed"),
        ("seed", 1.5, "type"),
        ("image_transport", "compressed", "read-only"),
        ("autostart", False, "read-only"),
    ],
)
def test_a_wrong_value_is_refused_with_the_reason_and_changes_nothing(hand, name, value, says):
    before = hand.node.get_parameter(name).value
    (result,) = hand.node.set_parameters([RosParameter(name, value=value)])
    assert not result.successful
    assert says in result.reason
    assert hand.node.get_parameter(name).value == before


def test_node_settings_apply_at_once(hand, made_footage):
    hand.node.set_parameters([RosParameter("max_gap", value=0.1)])
    outputs = hand.image(made_footage[0][1], 1.5)
    assert hand.state_of(outputs) == "LOST"
    hand.node.set_parameters([RosParameter("jump_back", value=100.0)])
    assert hand.image(made_footage[0][1], 0.1) == {}  # late now, not a jump


def test_tracker_settings_apply_with_the_next_box(hand, made_footage):
    frames, box = made_footage
    hand.node.set_parameters([RosParameter("sub_patches", value=4)])
    hand.node.on_image(image_message(frames[1], header_at(1 + 1 / 30)))
    assert hand.node._pursuit.session._tracker.config.sub_patches == 11
    hand.box(box)
    assert hand.node._pursuit.session._tracker.config.sub_patches == 4


def test_another_node_sets_a_parameter(graph):
    """What ``ros2 param set`` does, with its answer."""
    node = graph.add(TrackerNode(context=graph.context))
    client = AsyncParameterClient(graph.add(Node("user", context=graph.context)), "tracker")
    graph.spin_until(client.services_are_ready, "the parameter services")
    for value, fits in ((3.5, True), (-3.5, False)):
        future = client.set_parameters([RosParameter("max_gap", value=value)])
        graph.spin_until(future.done, "an answer")
        (result,) = future.result().results
        assert result.successful == fits
        assert node.get_parameter("max_gap").value == 3.5
