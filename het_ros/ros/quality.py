# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What to change when publisher and subscriber do not fit, by the parameter's name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum
from typing import Any, TypeVar

from rcl_interfaces.msg import SetParametersResult
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, qos_policy_name_from_kind
from rclpy.qos_overriding_options import InvalidQosOverridesError, QoSOverridingOptions

Made = TypeVar("Made")
POLICIES = (
    QoSPolicyKind.HISTORY,
    QoSPolicyKind.DEPTH,
    QoSPolicyKind.RELIABILITY,
    QoSPolicyKind.DURABILITY,
    QoSPolicyKind.DEADLINE,
    QoSPolicyKind.LIVELINESS,
)


def overridable(reliability: bool = True) -> QoSOverridingOptions:
    """Parameters for every policy by which publisher and subscriber may not fit.

    rclpy's own default leaves durability, deadline and liveliness out.

    Args:
        reliability: False where the caller has a parameter of its own for that.
    """
    kinds = [k for k in POLICIES if reliability or k is not QoSPolicyKind.RELIABILITY]
    return QoSOverridingOptions(policy_kinds=kinds, callback=_fits)


def _fits(qos: QoSProfile) -> SetParametersResult:
    """Whether the middleware will take it: what it says itself helps nobody."""
    fits = qos.depth >= 1
    return SetParametersResult(successful=fits, reason="" if fits else "depth is 1 or more")


def checked(make: Callable[[], Made], topic: str, end: str) -> Made:
    """A publisher or subscription; its overrides may be wrong.

    Args:
        make: makes it.
        topic: its full name.
        end: "publisher" or "subscription".

    Raises:
        ValueError: an override is wrong; the text names it.
    """
    try:
        return make()
    except (RuntimeError, InvalidQosOverridesError) as error:
        text = str(error).splitlines()[0]
        known = [
            f"{policy}: {', '.join(of)}" for policy, of in STRENGTHS.items() if policy in text
        ]
        more = f" ({known[0]})" if known else ""
        raise ValueError(f"qos_overrides.{topic}.{end}: {text}{more}") from error


def override_name(topic: str, end: str, policy: str) -> str:
    """The parameter of one policy of a topic's "publisher" or "subscription"."""
    return f"qos_overrides.{topic}.{end}.{policy}"


def subscription_events(node: Node, topic: str) -> SubscriptionEventCallbacks:
    """Callbacks that explain a publisher which offers less than this subscription asks for."""
    full = node.resolve_topic_name(topic)

    def explain(event: Any) -> None:
        policy = _policy(event)
        profiles = [info.qos_profile for info in node.get_publishers_info_by_topic(full)]
        value = setting(profiles, policy, least=True)
        node.get_logger().warning(
            f"a publisher on {full} offers another {policy} than is asked for: nothing comes "
            f"from it. Start this node with -p "
            f"{override_name(full, 'subscription', policy)}:={value} to ask for what it offers, "
            "or change the publisher"
        )

    return SubscriptionEventCallbacks(incompatible_qos=explain)


def publisher_events(node: Node, topic: str) -> PublisherEventCallbacks:
    """Callbacks that explain a subscriber which asks for more than this publisher offers."""
    full = node.resolve_topic_name(topic)

    def explain(event: Any) -> None:
        policy = _policy(event)
        profiles = [info.qos_profile for info in node.get_subscriptions_info_by_topic(full)]
        value = setting(profiles, policy, least=False)
        node.get_logger().warning(
            f"a subscriber of {full} asks for another {policy} than is offered: it gets nothing. "
            f"Start this node with -p {override_name(full, 'publisher', policy)}:={value}, or "
            "change the subscriber"
        )

    return PublisherEventCallbacks(incompatible_qos=explain)


# From what promises least to what promises most.
STRENGTHS = {
    "reliability": ("best_effort", "reliable"),
    "durability": ("volatile", "transient_local"),
    "liveliness": ("automatic", "manual_by_topic"),
}


def setting(profiles: Iterable[QoSProfile], policy: str, least: bool) -> str:
    """The value of a policy's parameter that fits all profiles of the other end.

    Args:
        profiles: of the other end; without any the answer is the least (or most) there is.
        policy: its name.
        least: they offer, and no more than the least of them can be asked for; else they ask,
            and the most is to be offered.
    """
    values = [_plain(getattr(profile, policy)) for profile in profiles]
    if policy in STRENGTHS:
        order = STRENGTHS[policy]
        known = sorted((v for v in values if v in order), key=order.index) or list(order)
        return str(known[0 if least else -1])
    if not values:
        return "VALUE"
    # A longer deadline promises less.
    return str(max(values) if least else min(values))


def _plain(value: Any) -> Any:
    if isinstance(value, Duration):
        return value.nanoseconds
    return value.name.lower() if isinstance(value, Enum) else value


def _policy(event: Any) -> str:
    return qos_policy_name_from_kind(QoSPolicyKind(event.last_policy_kind)).lower()
