# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``~/detections``: the estimate as vision_msgs has it, where vision_msgs is installed."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from std_msgs.msg import Header

from het_ros.tracking.estimate import Estimate

try:
    from vision_msgs import msg as vision_msgs
except ImportError:
    vision_msgs = None


def detections_message(
    estimate: Estimate, track: int, header: Header, vision: ModuleType | Any = vision_msgs
) -> Any:
    """One detection: the box in px, the score, and an id that stays the same for a track."""
    box = vision.BoundingBox2D()
    box.center.position.x, box.center.position.y = map(float, estimate.box.centre)
    box.size_x, box.size_y = float(estimate.box.w), float(estimate.box.h)
    result = vision.ObjectHypothesisWithPose()
    result.hypothesis.class_id = "target"
    result.hypothesis.score = float(estimate.score)
    detection = vision.Detection2D()
    detection.header, detection.bbox = header, box
    detection.results = [result]
    detection.id = str(track)
    message = vision.Detection2DArray()
    message.header, message.detections = header, [detection]
    return message
