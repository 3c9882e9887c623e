# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What to change when publisher and subscriber do not fit, by the parameter's name."""

from __future__ import annotations

from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, qos_policy_name_from_kind
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.subscription import Subscription

POLICIES = (
    QoSPolicyKind.HISTORY,
    QoSPolicyKind.DEPTH,
    QoSPolicyKind.RELIABILITY,
    QoSPolicyKind.DURABILITY,
    QoSPolicyKind.DEADLINE,
    QoSPolicyKind.LIVELINESS,
)


def overridable() -> QoSOverridingOptions:
    """Parameters for every policy by which publisher and subscriber may not fit.

    rclpy's own default leaves durability, deadline and liveliness out.
    """
    return QoSOverridingOptions(policy_kinds=POLICIES)


def subscription_events(node: Node, topic: str) -> SubscriptionEventCallbacks:
    """Callbacks that explain a publisher which offers less than this subscription asks for."""
    full = node.resolve_topic_name(topic)

    def explain(event: Any) -> None:
        policy = _policy(event)
        node.get_logger().warning(
            f"a publisher on {full} offers another {policy} than is asked for: nothing comes "
            f"from it. Start this node with -p qos_overrides.{full}.subscription.{policy}:=VALUE "
            "to ask for what it offers, or change the publisher"
        )

    return SubscriptionEventCallbacks(incompatible_qos=explain)


def publisher_events(node: Node, topic: str) -> PublisherEventCallbacks:
    """Callbacks that explain a subscriber which asks for more than this publisher offers."""
    full = node.resolve_topic_name(topic)

    def explain(event: Any) -> None:
        policy = _policy(event)
        node.get_logger().warning(
            f"a subscriber of {full} asks for another {policy} than is offered: it gets nothing. "
            f"Start this node with -p qos_overrides.{full}.publisher.{policy}:=VALUE, or change "
            "the subscriber"
        )

    return PublisherEventCallbacks(incompatible_qos=explain)


def explain_silence(node: Node, subscription: Subscription, seconds: float) -> str:
    """What an input waits on and who publishes there, for a log."""
    topic = subscription.topic_name
    found = ", ".join(
        f"{info.node_name} ({info.topic_type}, {info.qos_profile.reliability.name.lower()})"
        for info in node.get_publishers_info_by_topic(topic)
    )
    reliability = subscription.qos_profile.reliability.name.lower()
    return (
        f"no image after {seconds:g} s: waiting on {topic} ({subscription.msg_type.__name__}, "
        f"{reliability}); its publishers: "
        f"{found or 'none, remap with -r image:=/your/camera/image_raw'}"
    )


def _policy(event: Any) -> str:
    return qos_policy_name_from_kind(QoSPolicyKind(event.last_policy_kind)).lower()
