# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""vision_msgs 4 (Jazzy) as far as it is used: a field that it does not have cannot be set.

The package is not on PyPI; where apt's is installed the tests take that as well.
"""

from dataclasses import dataclass, field
from types import SimpleNamespace

from geometry_msgs.msg import PoseWithCovariance
from std_msgs.msg import Header


@dataclass(slots=True)
class Point2D:
    x: float = 0.0
    y: float = 0.0


@dataclass(slots=True)
class Pose2D:
    position: Point2D = field(default_factory=Point2D)
    theta: float = 0.0


@dataclass(slots=True)
class BoundingBox2D:
    center: Pose2D = field(default_factory=Pose2D)
    size_x: float = 0.0
    size_y: float = 0.0


@dataclass(slots=True)
class ObjectHypothesis:
    class_id: str = ""
    score: float = 0.0


@dataclass(slots=True)
class ObjectHypothesisWithPose:
    hypothesis: ObjectHypothesis = field(default_factory=ObjectHypothesis)
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)


@dataclass(slots=True)
class Detection2D:
    header: Header = field(default_factory=Header)
    results: list = field(default_factory=list)
    bbox: BoundingBox2D = field(default_factory=BoundingBox2D)
    id: str = ""


@dataclass(slots=True)
class Detection2DArray:
    header: Header = field(default_factory=Header)
    detections: list = field(default_factory=list)


VISION = SimpleNamespace(
    BoundingBox2D=BoundingBox2D,
    ObjectHypothesisWithPose=ObjectHypothesisWithPose,
    Detection2D=Detection2D,
    Detection2DArray=Detection2DArray,
)
