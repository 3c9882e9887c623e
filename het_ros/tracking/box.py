# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Axis-aligned boxes in pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Box:
    """A box (x, y, w, h) in px; (0, 0) is the top-left corner of the top-left pixel.

    The box covers [x, x + w) x [y, y + h), so a box of one pixel is (column, row, 1, 1) and its
    centre is (x + w / 2, y + h / 2). Coordinates are floats and may lie outside the image.

    Raises:
        ValueError: a value is NaN or infinite, or a side is not positive.
    """

    x: float
    y: float
    w: float
    h: float

    def __post_init__(self) -> None:
        # Not in a loop: a frame makes a box for each sub-patch.
        finite = math.isfinite(self.x) and math.isfinite(self.y)
        if not (finite and math.isfinite(self.w) and math.isfinite(self.h)):
            raise ValueError(f"a box needs finite numbers, not {self}: send x, y, w, h in px")
        if self.w <= 0 or self.h <= 0:
            raise ValueError(f"a box needs a positive width and height, not {self.w} x {self.h}")

    @classmethod
    def from_centre(cls, cx: float, cy: float, w: float, h: float) -> Box:
        """Box of size (w, h) px around the centre (cx, cy) px."""
        return cls(cx - w / 2, cy - h / 2, w, h)

    @property
    def centre(self) -> tuple[float, float]:
        """Centre (x, y), px."""
        return self.x + self.w / 2, self.y + self.h / 2

    @property
    def area(self) -> float:
        """Area, px^2."""
        return self.w * self.h

    def turned(self, angle: float) -> Box:
        """Upright box around the ellipse that fills this one, turned by ``angle``, rad."""
        cosine, sine = math.cos(angle), math.sin(angle)
        width = math.hypot(self.w * cosine, self.h * sine)
        height = math.hypot(self.w * sine, self.h * cosine)
        return Box.from_centre(*self.centre, width, height)

    def as_tuple(self) -> tuple[float, float, float, float]:
        """(x, y, w, h), px."""
        return self.x, self.y, self.w, self.h

    def intersection(self, other: Box) -> float:
        """Area that both boxes cover, px^2."""
        width = min(self.x + self.w, other.x + other.w) - max(self.x, other.x)
        height = min(self.y + self.h, other.y + other.h) - max(self.y, other.y)
        return max(width, 0.0) * max(height, 0.0)

    def iou(self, other: Box) -> float:
        """Intersection over union with another box, 0..1 (PASCAL VOC's overlap)."""
        shared = self.intersection(other)
        return shared / (self.area + other.area - shared)

    def touches_image(self, width: int, height: int) -> bool:
        """Whether any part of the box lies inside an image of that size in px."""
        return self.intersection(Box(0, 0, width, height)) > 0
