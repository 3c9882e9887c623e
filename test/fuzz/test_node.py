# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole node: any message, service, transition and parameter in any order; then good frames.

Callbacks are taken from the node's own entities, as an executor would, and get messages that went
through serialisation. What is raised in one comes out here.
"""

import atexit
from functools import cache
from inspect import signature

import cv2
import numpy as np
import rclpy
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParameters
from rclpy.lifecycle import LifecycleNode
from rclpy.logging import LoggingSeverity
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.serialization import deserialize_message, serialize_message
from ros.streams import box_message, header_at, image_message
from sensor_msgs.msg import CompressedImage
from std_srvs.srv import SetBool, Trigger

from het_ros import Box, TrackerConfig
from het_ros.ros.images import to_array
from het_ros.ros.messages import box_from_polygon, stamp_ns
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.status import status_values
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tracking.parameter import parameters_of

from .cases import COUNTS, cases
from .footage import BOX, frames
from .sane import check_message
from .strategies import (
    anything,
    camera_infos,
    compressed_images,
    depth_images,
    headers,
    images,
    polygons,
    regions,
    right_values,
)

DECLARED = {p.name: p for kind in (TrackerConfig, NodeConfig) for p in parameters_of(kind)}
# Dear ones are set to little, so that a case stays quick; test_conversions tries their ranges.
CHEAP = {
    "working_side": st.sampled_from([8.0, 48.0]),
    "sub_patches": st.integers(1, 12),
    "features": st.integers(1, 150),
    "search_radius": st.floats(8, 40),
    "network": st.just(""),
}
STEPS = st.sampled_from([1 / 30] * 5 + [0.0, -0.05, -0.5, -30.0, 0.5, 3.0, 1e6])
NAMES = st.sampled_from([*DECLARED, "use_sim_time", "no_such_parameter"])
TRANSITIONS = [
    Transition.TRANSITION_CONFIGURE,
    Transition.TRANSITION_CLEANUP,
    Transition.TRANSITION_ACTIVATE,
    Transition.TRANSITION_DEACTIVATE,
    77,
]


@cache
def context() -> rclpy.Context:
    """One for all cases: each of its own would cost threads and memory until it is collected."""
    made = rclpy.Context()
    rclpy.init(context=made)
    atexit.register(made.try_shutdown)
    return made


def delivered(message):
    """A message as it comes out of the middleware."""
    return deserialize_message(serialize_message(message), type(message))


class Node(RuleBasedStateMachine):
    """Nothing out of a callback, nothing insane published; and it always comes back."""

    @initialize(transport=st.sampled_from(["raw", "raw", "compressed"]))
    def start(self, transport):
        COUNTS["node"] += 1
        self.compressed = transport == "compressed"
        self.sent = {}
        self.time = 10.0
        self.shown = 0
        self.sequence = 0
        self.stamps = []
        self.node = TrackerNode(
            context=context(),
            tap=self.hear,
            parameter_overrides=[Parameter("image_transport", value=transport)],
        )
        self.node.get_logger().set_level(LoggingSeverity.FATAL)

    def hear(self, topic, message):
        check_message(topic, message)
        serialize_message(message)  # refuses what is out of a field's range
        self.sent[topic] = message

    def feed(self, topic, message):
        """Give a message to whoever subscribes; nobody does while the node is not active."""
        if "/image" in topic:
            self.stamps.append(stamp_ns(message.header) / 1e9)
        for subscription in tuple(self.node.subscriptions):
            if subscription.topic_name.endswith(topic):
                arguments = [delivered(message)]
                if len(signature(subscription.callback).parameters) == 2:
                    self.sequence += 1
                    arguments.append({"publication_sequence_number": self.sequence})
                subscription.callback(*arguments)

    def call(self, name, kind, **request):
        """Call a service, if the node offers it now."""
        for service in tuple(self.node.services):
            if service.srv_name.endswith(name):
                return service.callback(kind.Request(**request), kind.Response())
        return None

    def show(self, frame, step=1 / 30):
        self.time = max(self.time + step, 0.1)
        message = image_message(frames()[frame % len(frames())], header_at(self.time))
        self.send(message)

    def send(self, message):
        self.sent.clear()
        if self.compressed:
            data = cv2.imencode(".png", to_array(message))[1].tobytes()
            message = CompressedImage(header=message.header, format="png", data=data)
        self.feed("/image/compressed" if self.compressed else "/image", message)

    # What comes in --------------------------------------------------------------------------

    @rule(step=STEPS, count=st.sampled_from([1, 1, 3]))
    def good_images(self, step, count):
        for _ in range(count):
            self.shown += 1
            self.show(self.shown, step)

    @rule(data=st.data(), soon=st.booleans())
    def any_image(self, data, soon):
        self.time += 1 / 30 if soon else 0
        header = header_at(self.time) if soon else None
        if self.compressed:
            self.feed("/image/compressed", data.draw(compressed_images(header)))
        else:
            self.feed("/image", data.draw(images(header)))

    @rule(frame_id=st.text("ab", max_size=3), width=st.sampled_from([0, 1, 2, 20, 80]))
    def another_camera(self, frame_id, width):
        self.time += 1 / 30
        part = np.ascontiguousarray(frames()[0][: width or 120, : width or 160])
        self.send(image_message(part, header_at(self.time, frame_id)))

    @rule(back=st.sampled_from([0.0, 1 / 30, 0.1, 0.9, 5.0, -1.0]), stamped=st.booleans())
    def good_box(self, back, stamped):
        header = header_at(max(self.time - back, 0)) if stamped else None
        self.feed("/init_box", box_message(BOX.as_tuple(), header))

    @rule(data=st.data(), soon=st.booleans())
    def any_box(self, data, soon):
        self.feed("/init_box", data.draw(polygons(header_at(self.time) if soon else None)))

    @rule(region=regions)
    def any_region(self, region):
        self.feed("/init_roi", region)

    @rule(info=camera_infos())
    def any_camera_info(self, info):
        self.feed("/camera_info", info)

    @rule(data=st.data(), soon=st.booleans())
    def any_depth(self, data, soon):
        self.feed("/depth", data.draw(depth_images(header_at(self.time) if soon else None)))

    @rule(sequence=st.sampled_from([0, 5, 2**63, 2**64 - 2]) | st.integers(0, 2**64 - 2))
    def lost_on_the_way(self, sequence):
        self.sequence = sequence

    @rule(header=headers())
    def good_image_of_any_time(self, header):
        self.send(image_message(frames()[0], header))

    # What is asked of it --------------------------------------------------------------------

    @rule()
    def reset(self):
        self.call("/reset", Trigger)

    @rule(on=st.booleans())
    def enable(self, on):
        self.call("/enable", SetBool, data=on)

    @rule(transition=st.sampled_from(TRANSITIONS))
    def change_state(self, transition):
        self.call("/change_state", ChangeState, transition=Transition(id=transition))

    @rule(
        values=st.dictionaries(NAMES, anything, max_size=3)
        | st.sampled_from([*DECLARED]).flatmap(
            lambda name: st.fixed_dictionaries(
                {name: CHEAP[name] if name in CHEAP else right_values(DECLARED[name])}
            )
        )
    )
    def set_parameters(self, values):
        wanted = []
        for name, value in values.items():
            if name in CHEAP and isinstance(value, (int, float)) and value > 200:
                continue
            try:
                made = Parameter(name, value=list(value) if isinstance(value, tuple) else value)
            except (TypeError, ValueError):  # what no message can hold
                continue
            wanted.append(made.to_parameter_msg())
        self.set(wanted)

    @rule()
    def timers(self):
        for timer in tuple(self.node.timers):
            timer.callback()

    def set(self, wanted: list[ParameterMessage]) -> list[str]:
        """Set parameters through the node's service; why each was refused, or ''."""
        response = self.call("/set_parameters", SetParameters, parameters=wanted)
        for parameter, result in zip(wanted, response.results, strict=True):
            if result.successful:
                value = parameter_value_to_python(parameter.value)
                assert self.node.get_parameter(parameter.name).value is not None or value is None
        return ["" if result.successful else result.reason for result in response.results]

    # And then -------------------------------------------------------------------------------

    def teardown(self):
        """Defaults again, active, a camera that runs: the next good frames are tracked."""
        if not hasattr(self, "node"):
            return
        try:
            self.recover()
        finally:
            # Levels are the process's, by name: the next node of this name has a log again.
            self.node.get_logger().set_level(LoggingSeverity.INFO)
            self.node.destroy_node()

    def recover(self):
        assert isinstance(self.node, LifecycleNode)
        for transition in (
            Transition.TRANSITION_DEACTIVATE,
            Transition.TRANSITION_CLEANUP,
            Transition.TRANSITION_CONFIGURE,
            Transition.TRANSITION_ACTIVATE,
        )[0 if self.shown % 2 else 2 :]:
            self.call("/change_state", ChangeState, transition=Transition(id=transition))
        self.restore_parameters()
        self.call("/enable", SetBool, data=True)
        self.call("/reset", Trigger)
        # A later camera, or time that jumps back; by less than jump_back, frames are but late.
        times = (2e9, 5.0) if self.shown % 3 else (5.0, 2e9)
        far = [t for t in (*times, 1e9, 500.0) if not any(t < s < t + 2 for s in self.stamps)]
        self.time = far[0]
        self.show(0)
        self.show(0)
        self.feed("/init_box", box_message(BOX.as_tuple()))
        for frame in (1, 2, 3):
            self.show(frame)
            assert status_values(self.sent["status"])["state"] == "TRACKING", self.sent["status"]
        box = box_from_polygon(self.sent["box"])
        assert box.iou(Box(BOX.x + 6, BOX.y + 1, BOX.w, BOX.h)) > 0.6, box

    def restore_parameters(self):
        """Three rounds: a value may fit only with others that are still to be set."""
        for _ in range(3):
            wanted = []
            for name, declared in DECLARED.items():
                if not declared.read_only:
                    default = declared.default
                    value = list(default) if isinstance(default, tuple) else default
                    wanted.append(Parameter(name, value=value).to_parameter_msg())
            refused = [reason for reason in self.set(wanted) if reason]
        assert not refused, refused


TestNode = Node.TestCase
TestNode.settings = cases(25, stateful_step_count=25)
