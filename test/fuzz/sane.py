# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What must hold of everything that leaves the tracker or the node."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from geometry_msgs.msg import PolygonStamped

from het_ros.ros.status import status_values
from het_ros.tracking.estimate import Estimate, State

STATES = {state.value for state in State}


def check_estimate(estimate: Estimate) -> None:
    """Finite numbers, a box with sides, a covariance that is one, a score in 0..1."""
    box = estimate.box
    assert all(map(math.isfinite, (*box.as_tuple(), *estimate.velocity))), estimate
    assert box.w > 0 and box.h > 0, estimate
    assert 0 <= estimate.score <= 1, estimate
    covariance = estimate.covariance
    assert covariance.shape == (4, 4) and np.isfinite(covariance).all(), estimate
    assert (np.diag(covariance) >= 0).all(), estimate
    for patch in estimate.patches:
        assert all(map(math.isfinite, (*patch.box.as_tuple(), patch.weight))), estimate


def check_message(topic: str, message: Any) -> None:
    """No number that is none, no box without sides, a status that can be read."""
    for name, number in numbers_of(message):
        assert math.isfinite(number), f"{topic}: {name} is {number}"
    if isinstance(message, PolygonStamped):
        left_top, _, right_bottom, _ = message.polygon.points
        assert right_bottom.x >= left_top.x and right_bottom.y >= left_top.y, message
    if topic == "status":
        values = status_values(message)
        assert values["state"] in STATES
        assert 0 <= float(values["score"]) <= 1, values
        assert float(values["latency_ms"]) >= 0, values
        assert math.isfinite(float(values["age_s"])) and float(values["age_s"]) >= 0, values
        assert (values["reason"] == "") == (values["state"] == "TRACKING"), values
    if topic in ("pose", "velocity"):
        covariance = (message.pose if topic == "pose" else message.twist).covariance
        assert all(value >= 0 for value in covariance[::7]), covariance


def numbers_of(message: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """Every float in a message, with its name."""
    if isinstance(message, float):
        yield path, message
    elif hasattr(message, "get_fields_and_field_types"):
        for field in message.get_fields_and_field_types():
            yield from numbers_of(getattr(message, field), f"{path}.{field}")
    elif isinstance(message, (list, tuple, np.ndarray)):
        for index, item in enumerate(message):
            yield from numbers_of(item, f"{path}[{index}]")
