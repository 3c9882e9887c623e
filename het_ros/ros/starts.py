# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The messages that start a track: a polygon, a region, or a point on what is detected."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import PointStamped, PolygonStamped
from sensor_msgs.msg import RegionOfInterest

from het_ros.ros.detections import vision_msgs
from het_ros.ros.detector import Detector, click_of, detections_of
from het_ros.ros.messages import BoxError, box_from_polygon, box_from_roi, stamp_ns
from het_ros.tracking.box import Box

Start = Callable[[Box, int], None]
WITHOUT_VISION = (
    "a point needs detections, and vision_msgs is not installed: sudo apt install "
    "ros-jazzy-vision-msgs"
)


class Starts:
    """Makes a box of whatever asks for a track.

    Attributes:
        detector: what another node detects.

    Args:
        detector: see above.
        start: called with a box and the stamp (ns) of its image, 0 for the newest; may raise
            BoxError.
        refuse: called with the reason where nothing is started.
    """

    def __init__(self, detector: Detector, start: Start, refuse: Callable[[object], None]) -> None:
        self.detector = detector
        self._start = start
        self._refuse = refuse

    def on_box(self, message: PolygonStamped) -> None:
        """Start on the polygon's bounds, on the image of its stamp."""
        self._or_refuse(lambda: self._start(box_from_polygon(message), stamp_ns(message.header)))

    def on_roi(self, message: RegionOfInterest) -> None:
        """Start on a region of the newest image."""
        self._or_refuse(lambda: self._start(box_from_roi(message), 0))

    def on_point(self, message: PointStamped, tolerance: float) -> None:
        """Start on what is detected around a point, ``tolerance`` s from its image, or wait."""

        def choose() -> None:
            if vision_msgs is None and not self.detector.heard:
                raise BoxError(WITHOUT_VISION)
            self._start_on(self.detector.click(click_of(message), tolerance))

        self._or_refuse(choose)

    def on_detections(self, message: Any) -> None:
        """Take a vision_msgs/Detection2DArray; start on it if a point waits for it."""
        self._or_refuse(lambda: self._start_on(self.detector.take(detections_of(message))))

    def look(self) -> None:
        """Refuse a point that has waited long enough."""
        self._or_refuse(self.detector.check)

    def _start_on(self, found: tuple[Box, int] | None) -> None:
        if found is not None:
            self._start(*found)

    def _or_refuse(self, work: Callable[[], None]) -> None:
        try:
            work()
        except BoxError as error:
            self._refuse(error)
