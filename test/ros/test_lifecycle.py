"""The managed node as a manager in another node sees it, by its services."""

from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
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
