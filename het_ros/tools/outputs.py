# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tracker's output topics: what to record of them, and how to read a recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from het_ros.ros.status import status_values
from het_ros.tools.bag_messages import DIAGNOSTICS, POLYGON, box_of, stamp_of
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.results import Row
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import State

DEFAULT_TRACKER = "/tracker"  # the node's full name

OUTPUT_TYPES = {  # by the name under the node's own
    "box": POLYGON,
    "pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "velocity": "geometry_msgs/msg/TwistWithCovarianceStamped",
    "status": DIAGNOSTICS,
    "bearing": "geometry_msgs/msg/Vector3Stamped",
    "target_pose": "geometry_msgs/msg/PoseStamped",
    "target_pose_cov": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "target_velocity": "geometry_msgs/msg/TwistWithCovarianceStamped",
    "velocity_in_scene": "geometry_msgs/msg/TwistWithCovarianceStamped",
}


def read_answers(
    bag: Path | str, stamps: Sequence[int], tracker: str = DEFAULT_TRACKER
) -> list[Row]:
    """One row for each frame out of a recording of the tracker's outputs.

    Args:
        bag: folder of the recording.
        stamps: header stamps of the frames that were sent, ns.
        tracker: the node's full name.

    Returns:
        As many rows as stamps; a frame that got no answer has no state.

    Raises:
        BagError: the recording cannot be read.
    """
    boxes: dict[int, Box] = {}
    velocities: dict[int, tuple[float, float]] = {}
    deviations: dict[int, float] = {}
    statuses: dict[int, dict[str, str]] = {}
    with BagReader(bag) as reader:
        topics = {f"{tracker}/{name}": name for name in ("box", "velocity", "status")}
        for topic, message in reader.messages(*topics):
            stamp = stamp_of(message)
            if topics[topic] == "box":
                boxes[stamp] = box_of(message)
            elif topics[topic] == "velocity":
                linear = message.twist.twist.linear
                velocities[stamp] = (float(linear.x), float(linear.y))
                deviations[stamp] = max(float(message.twist.covariance[0]), 0.0) ** 0.5
            else:
                statuses[stamp] = status_values(message)
    rows = [
        _row(stamp, statuses.get(stamp), boxes.get(stamp), velocities.get(stamp))
        for stamp in stamps
    ]
    return [replace(row, velocity_deviation=deviations.get(row.stamp)) for row in rows]


def read_latencies(bag: Path | str, tracker: str = DEFAULT_TRACKER) -> NDArray[np.float64]:
    """Time from a frame's arrival to its answer, ms, of each status in a recording."""
    with BagReader(bag) as reader:
        statuses = reader.messages(f"{tracker}/status")
        return np.array([float(status_values(m)["latency_ms"]) for _, m in statuses])


def _row(
    stamp: int,
    status: dict[str, str] | None,
    box: Box | None,
    velocity: tuple[float, float] | None,
) -> Row:
    if status is None:
        return Row(stamp)
    return Row(stamp, box, velocity, float(status["score"]), State(status["state"]))
