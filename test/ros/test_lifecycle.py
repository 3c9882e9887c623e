# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The managed node as a manager in another node sees it, by its services."""

import pytest
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import Image

from het_ros.ros.tracker_node import TrackerNode


def called(graph, manager, kind, name, request):
    client = manager.create_client(kind, f"tracker/{name}")
    graph.spin_until(client.service_is_ready, name)
    future = client.call_async(request)
    graph.spin_until(future.done, name)
    return future.result()


def test_a_manager_in_another_node_takes_it_through_its_states(graph):
    """The order of Nav2's lifecycle manager: configure, activate, deactivate, cleanup, again."""
    by_hand = [Parameter("autostart", value=False)]
    graph.add(TrackerNode(context=graph.context, parameter_overrides=by_hand))
    manager = graph.add(Node("manager", context=graph.context))
    camera = manager.create_publisher(Image, "image", 1)
    steps = [
        (Transition.TRANSITION_CONFIGURE, State.PRIMARY_STATE_INACTIVE, 0),
        (Transition.TRANSITION_ACTIVATE, State.PRIMARY_STATE_ACTIVE, 1),
        (Transition.TRANSITION_DEACTIVATE, State.PRIMARY_STATE_INACTIVE, 0),
        (Transition.TRANSITION_CLEANUP, State.PRIMARY_STATE_UNCONFIGURED, 0),
    ]
    for transition, state, listening in steps * 2:
        request = ChangeState.Request(transition=Transition(id=transition))
        assert called(graph, manager, ChangeState, "change_state", request).success
        answer = called(graph, manager, GetState, "get_state", GetState.Request())
        assert answer.current_state.id == state
        graph.spin_until(
            lambda wanted=listening: camera.get_subscription_count() == wanted, "the subscription"
        )


def test_by_itself_it_is_active(graph):
    graph.add(TrackerNode(context=graph.context))
    manager = graph.add(Node("manager", context=graph.context))
    answer = called(graph, manager, GetState, "get_state", GetState.Request())
    assert answer.current_state.id == State.PRIMARY_STATE_ACTIVE


def test_a_configuration_that_fails_tells_why_and_leaves_nothing_behind(graph, monkeypatch):
    by_hand = [Parameter("autostart", value=False)]
    node = graph.add(TrackerNode(context=graph.context, parameter_overrides=by_hand))
    before = node.get_publisher_names_and_types_by_node("tracker", "/")

    def broken(*_):
        raise OSError("on purpose")

    monkeypatch.setattr(node, "create_guard_condition", broken)  # the last thing that is made
    assert node.trigger_configure() is TransitionCallbackReturn.FAILURE
    assert node.get_publisher_names_and_types_by_node("tracker", "/") == before
    with pytest.raises(RuntimeError, match="on purpose"):
        node.start()
    monkeypatch.undo()
    node.start()


def test_a_shutdown_takes_everything_away(graph):
    node = graph.add(TrackerNode(context=graph.context))
    node.trigger_shutdown()
    assert not [s for s in node.subscriptions if s.topic_name.startswith("/image")]
    assert not [p for p in node.publishers if p.topic_name.startswith("/tracker/box")]


@pytest.mark.parametrize("transition", [1, 2, 3, 77, 255])
def test_a_transition_that_its_state_does_not_have_is_refused(graph, transition):
    """rclpy's own service raised out of the executor: one call from anywhere ended the process."""
    graph.add(TrackerNode(context=graph.context))
    manager = graph.add(Node("manager", context=graph.context))
    request = ChangeState.Request(transition=Transition(id=transition))
    assert not called(graph, manager, ChangeState, "change_state", request).success
    answer = called(graph, manager, GetState, "get_state", GetState.Request())
    assert answer.current_state.id == State.PRIMARY_STATE_ACTIVE
