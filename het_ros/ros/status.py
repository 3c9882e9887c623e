# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``~/status``: what the tracker thinks of itself, every processed frame."""

from __future__ import annotations

from dataclasses import dataclass

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Header

from het_ros.tracking.estimate import State

# The same on ~/status and /diagnostics.
LEVELS = {
    State.IDLE: DiagnosticStatus.OK,
    State.TRACKING: DiagnosticStatus.OK,
    State.COASTING: DiagnosticStatus.WARN,
    State.LOST: DiagnosticStatus.ERROR,
}


def level_of(state: State, trouble: bool = False) -> bytes:
    """The level that a state is told with; at least WARN while no images come in."""
    return max(LEVELS[state], DiagnosticStatus.WARN) if trouble else LEVELS[state]


@dataclass(frozen=True)
class Status:
    """One frame's status.

    Attributes:
        state: where the track stands.
        score: 0..1, probability that the box is right; 0 without one.
        latency: s from the frame's arrival to the status.
        age: s since the target was last measured; 0 while it is, and without a target.
        reason: why the state is not TRACKING; empty while it is.
        trouble: whether no images come in.
    """

    state: State
    score: float
    latency: float
    age: float
    reason: str
    trouble: bool = False


def status_message(status: Status, name: str, header: Header) -> DiagnosticArray:
    """One status with its values as text: state, score, latency_ms, age_s, reason."""
    values = {
        "state": status.state.value,
        "score": f"{status.score:.4f}",
        "latency_ms": f"{1e3 * status.latency:.2f}",
        "age_s": f"{status.age:.3f}",
        "reason": status.reason,
    }
    text = f"{status.state.value}: {status.reason}" if status.reason else status.state.value
    return DiagnosticArray(
        header=header,
        status=[
            DiagnosticStatus(
                level=level_of(status.state, status.trouble),
                name=name,
                message=text,
                hardware_id=header.frame_id,  # the camera's
                values=[KeyValue(key=key, value=value) for key, value in values.items()],
            )
        ],
    )


def status_values(message: DiagnosticArray) -> dict[str, str]:
    """The key-value pairs of a message made by :func:`status_message`."""
    return {pair.key: pair.value for pair in message.status[0].values}
