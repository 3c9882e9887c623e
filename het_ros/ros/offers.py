# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A subscription that asks for the reliability that its publishers offer.

Best effort hears every publisher, but loses every image of which one fragment is lost, and most
images where the shared memory of the middleware is smaller than an image. Reliable loses next to
none, but hears only publishers that offer it. What is offered is known once they are discovered.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from copy import copy
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import ParameterAlreadyDeclaredException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from het_ros.ros.quality import checked, overridable, override_name, subscription_events

AUTO = "auto"
RELIABILITIES = {
    "reliable": ReliabilityPolicy.RELIABLE,
    "best_effort": ReliabilityPolicy.BEST_EFFORT,
}
LOOK = 0.5  # s between two looks at what is offered
Take = Callable[[Any, dict[str, Any]], None]


class OfferedSubscription:
    """Messages of a topic, with the best reliability that all its publishers offer.

    The parameter ``qos_overrides.<topic>.subscription.reliability`` fixes it instead.

    Attributes:
        topic: its full name.
        subscription: the one whose publishers are known, or the newest.

    Args:
        node: subscribes.
        kind: message type.
        topic: its name, before remapping.
        take: called with each message and what the middleware says of it.
        qos: of the subscription but for its reliability.
        reliability: ``auto``, or what is asked for whatever is offered.

    Raises:
        ValueError: the parameter is none of ``auto``, ``reliable`` and ``best_effort``.
    """

    def __init__(
        self, node: Node, kind: Any, topic: str, take: Take, qos: QoSProfile, reliability: str
    ) -> None:
        self._node = node
        self._kind = kind
        self._topic = topic
        self._take = take
        self._qos = qos
        self._newest: Any = None
        self._told = ""
        self._retired: list[Any] = []
        self._open = ExitStack()
        self.topic = node.resolve_topic_name(topic)
        asked = self._asked(reliability)
        first = self._offered() or "best_effort" if asked == AUTO else asked
        self.subscription = self._subscribe(first)
        if asked == AUTO:
            self.look()
            steady = Clock(clock_type=ClockType.STEADY_TIME)  # runs under use_sim_time as well
            timer = node.create_timer(LOOK, self.look, clock=steady)
            self._open.callback(node.destroy_timer, timer)

    @property
    def publishers(self) -> int:
        """How many publish here."""
        return int(self.subscription.get_publisher_count())

    @property
    def reliability(self) -> str:
        """What is asked for now: a key of ``RELIABILITIES``."""
        return str(self.subscription.qos_profile.reliability.name.lower())

    def look(self) -> None:
        """Ask for what is offered by now."""
        self._retire()
        best = self._offered()
        if not best:
            return
        if best != self.reliability:
            # The old one goes when the new one is heard: until then the new one is not known.
            self._retired.append(self.subscription)
            self.subscription = self._subscribe(best)
        if best != self._told:
            self._told = best
            self._node.get_logger().info(
                f"{self.topic} is asked for {best}, the best that its publishers offer "
                f"(fix it with -p {override_name(self.topic, 'subscription', 'reliability')}:=...)"
            )

    def _offered(self) -> str:
        """The best reliability that all publishers offer; empty without any."""
        found = self._node.get_publishers_info_by_topic(self.topic)
        if not found:
            return ""
        reliable = all(i.qos_profile.reliability is ReliabilityPolicy.RELIABLE for i in found)
        return "reliable" if reliable else "best_effort"

    def destroy(self) -> None:
        """Take all away."""
        self._open.close()
        self._retire()
        self._node.destroy_subscription(self.subscription)

    def _asked(self, reliability: str) -> str:
        """What the topic's own parameter says, or ``reliability`` where it is not set."""
        name = override_name(self.topic, "subscription", "reliability")
        descriptor = ParameterDescriptor(
            description="reliability asked for on this topic",
            additional_constraints=f"one of: {AUTO}, {', '.join(RELIABILITIES)}",
            read_only=True,
        )
        try:
            asked = self._node.declare_parameter(name, reliability, descriptor).value
        except ParameterAlreadyDeclaredException:
            asked = self._node.get_parameter(name).value
        if asked not in (AUTO, *RELIABILITIES):
            raise ValueError(
                f"{name} is one of {', '.join((AUTO, *RELIABILITIES))}, not {asked!r}"
            )
        return str(asked)

    def _subscribe(self, reliability: str) -> Any:
        qos = copy(self._qos)  # overrides are written into it
        qos.reliability = RELIABILITIES[reliability]

        def on_message(message: Any, info: dict[str, Any]) -> None:
            if made is self.subscription:
                self._retire()
            sent = info.get("source_timestamp")
            if sent is None or sent != self._newest:  # else both subscriptions heard it
                self._newest = sent
                self._take(message, info)

        # rclpy counts a callback's parameters to know whether it takes the second.
        made = checked(
            lambda: self._node.create_subscription(
                self._kind,
                self._topic,
                on_message,
                qos,
                event_callbacks=subscription_events(self._node, self._topic),
                qos_overriding_options=overridable(reliability=False),
            ),
            self.topic,
            "subscription",
        )
        return made

    def _retire(self) -> None:
        while self._retired:
            self._node.destroy_subscription(self._retired.pop())
