# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What another node detects: boxes for a click to choose from, and places to look at first.

A detector is late, misses and invents. So a box of its own starts nothing without a click, and
where a hidden target is looked for first it is accepted as anywhere else, by its looks.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import PointStamped

from het_ros.ros.messages import BoxError, stamp_ns
from het_ros.ros.stamps import SECOND
from het_ros.tracking.box import Box

KEPT = 10  # arrays
MOST_BOXES = 300  # of an array; the others are left out
OLDEST = 1.0  # s that detections are older than the image they are looked at for
CLICK_WAIT = 1.0  # s that a click waits for a detection around it
MOST_CANDIDATES = 5
REACH = (1.5, 3.0)  # target sides, and sides a second of hiding, that a target may be away
LARGER = 3.0  # times the target's area that a candidate has at most, or at least one of these


@dataclass(frozen=True)
class Detections:
    """The boxes of one image.

    Attributes:
        stamp: of the image, ns.
        boxes: px.
    """

    stamp: int
    boxes: tuple[Box, ...]

    def around(self, x: float, y: float) -> Box | None:
        """The smallest box that holds a point, px; None where none does."""
        holding = (b for b in self.boxes if b.x <= x < b.x + b.w and b.y <= y < b.y + b.h)
        return min(holding, key=lambda box: box.area, default=None)


@dataclass(frozen=True)
class Click:
    """A point that a target is to be started at, px, and the stamp (ns) of its image, or 0."""

    x: float
    y: float
    stamp: int


def detections_of(message: Any) -> Detections:
    """The boxes of a vision_msgs/Detection2DArray, without those that are none."""
    boxes = []
    for detection in message.detections[:MOST_BOXES]:
        centre, box = detection.bbox.center.position, detection.bbox
        numbers = centre.x, centre.y, box.size_x, box.size_y
        if all(map(math.isfinite, numbers)) and box.size_x > 0 and box.size_y > 0:
            boxes.append(Box.from_centre(*numbers))
    return Detections(stamp_ns(message.header), tuple(boxes))


def click_of(message: PointStamped) -> Click:
    """The click of a message.

    Raises:
        BoxError: it is no point of an image.
    """
    x, y = message.point.x, message.point.y
    if not (math.isfinite(x) and math.isfinite(y)):
        raise BoxError("the point is NaN or infinite")
    return Click(x, y, stamp_ns(message.header))


class Detector:
    """The newest detections, and the click that waits for one.

    Args:
        topic: where detections come from, for the words of a refusal.
        clock: monotonic, s.
    """

    def __init__(self, topic: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._topic = topic
        self._clock = clock
        self._kept: deque[Detections] = deque(maxlen=KEPT)
        self._click: tuple[Click, float] | None = None

    @property
    def heard(self) -> bool:
        """Whether there are any detections."""
        return bool(self._kept)

    def take(self, detections: Detections) -> tuple[Box, int] | None:
        """Keep detections; the box, and its image's stamp, that a click waited for."""
        if self._kept and detections.stamp < self._kept[-1].stamp - OLDEST * SECOND:
            self._kept.clear()  # time went back
        self._kept.append(detections)
        if self._click is None:
            return None
        click, _ = self._click
        if abs(detections.stamp - click.stamp) > OLDEST * SECOND and click.stamp:
            return None
        box = detections.around(click.x, click.y)
        if box is None:
            return None
        self._click = None
        return box, detections.stamp

    def click(self, click: Click, tolerance: float) -> tuple[Box, int] | None:
        """The box around a click, and the stamp (ns) of the image that it was detected in.

        Args:
            click: a newer one takes the place of one that waits.
            tolerance: s between the click's image and that of the detections.

        Returns:
            None where the click waits for a detection.
        """
        self._click = None
        for detections in sorted(self._kept, key=lambda d: self._off(d, click)):
            if self._off(detections, click) > tolerance * SECOND:
                break
            box = detections.around(click.x, click.y)
            if box is not None:
                return box, detections.stamp
        self._click = click, self._clock()
        return None

    def drop(self) -> None:
        """Forget the click that waits."""
        self._click = None

    def check(self) -> None:
        """Give up a click that has waited long enough.

        Raises:
            BoxError: it has; the text says for what.
        """
        if self._click is None or self._clock() - self._click[1] < CLICK_WAIT:
            return
        click, _ = self._click
        self._click = None
        where = f"({click.x:.0f}, {click.y:.0f})"
        if not self._kept:
            raise BoxError(f"no detection for the point {where}: nothing came on {self._topic}")
        count = len(self._kept[-1].boxes)
        raise BoxError(
            f"no detection around the point {where} within {CLICK_WAIT:g} s; {self._topic} "
            f"has {count} elsewhere: send a box"
        )

    def near(self, box: Box, hidden: float, stamp: int) -> Sequence[Box]:
        """Detections that may be a hidden target, the nearest first.

        Args:
            box: where the target is thought to be, px.
            hidden: for how long it has not been seen, s.
            stamp: of the image to look in, ns.
        """
        newest = max(
            (d for d in self._kept if abs(d.stamp - stamp) <= OLDEST * SECOND),
            key=lambda d: d.stamp,
            default=None,
        )
        if newest is None:
            return ()
        reach = (REACH[0] + REACH[1] * hidden) * math.sqrt(box.area)
        alike = [
            (math.dist(b.centre, box.centre), b)
            for b in newest.boxes
            if 1 / LARGER <= b.area / box.area <= LARGER
        ]
        nearest = sorted((d for d in alike if d[0] <= reach), key=lambda d: d[0])
        return tuple(b for _, b in nearest[:MOST_CANDIDATES])

    def _off(self, detections: Detections, click: Click) -> float:
        """How far detections are from a click in time, ns; the newest are where it has no time."""
        wanted = click.stamp or max(d.stamp for d in self._kept)
        return abs(detections.stamp - wanted)
