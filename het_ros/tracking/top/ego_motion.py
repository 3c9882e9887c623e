# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How far the whole picture moved since the last frame: what the camera itself did.

Two thumbnails are registered by phase correlation (Kuglin and Hines, 1975). What it finds is
believed only where the picture fits better there than where it was or where it was expected.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class EgoMotionConfig:
    """Constants of the ego-motion.

    Attributes:
        side: longer side of a thumbnail, px (chosen: about 1 % of a picture's side is seen).
        smallest: shorter side below which there is nothing to register, px (chosen).
        better: share of the difference left by any other explanation that may be left by what
            was registered (chosen: repeating patterns fit at several places about as well).
        steady_rate: weight of a new frame in the camera's mean velocity (chosen: three frames).
    """

    side: int = 128
    smallest: int = 16
    better: float = 0.85
    steady_rate: float = 0.3


class EgoMotion:
    """The camera's way from image to image.

    Args:
        image: the first one, (H, W, 3) or (H, W) uint8.

    Attributes:
        velocity: (x, y), px/s: its running mean.
    """

    def __init__(self, image: Image) -> None:
        self._config = EgoMotionConfig()
        self._size = image.shape[:2]
        self._thumbnail = thumbnail(image)
        self.velocity: Floats = np.zeros(2)

    def follow(self, image: Image, dt: float) -> Floats:
        """(x, y), image px: how far what stands still in the scene moved since the last image.

        Args:
            image: the next one; after one of another size nothing is known.
            dt: time between the two, s, positive.
        """
        before, now = self._thumbnail, thumbnail(image)
        same = image.shape[:2] == self._size
        self._thumbnail, self._size = now, image.shape[:2]
        if not same or min(now.shape) < self._config.smallest:
            return np.zeros(2)
        unit = max(self._size) / max(now.shape)
        shift: Floats = registered(before, now, self.velocity * dt / unit) * unit
        rate = self._config.steady_rate
        self.velocity = self.velocity + rate * (shift / dt - self.velocity)
        return shift


def thumbnail(image: Image) -> Image:
    """A small gray image (h, w) uint8 whose longer side is 128 px, or the image's if it has less.

    Of large images only every k-th px is read, so that it costs the same for all. What is left is
    halved first, which OpenCV does many times faster than shrinking by any other ratio.
    """
    plane, longest = image if image.ndim == 2 else image[..., 1], EgoMotionConfig().side
    ratio = min(1.0, longest / max(plane.shape))
    height, width = (max(1, round(side * ratio)) for side in plane.shape)
    step = max(1, max(plane.shape) // (2 * longest))
    plane = np.ascontiguousarray(plane[::step, ::step])
    if min(plane.shape) > 1 and max(plane.shape) >= 2 * longest:
        rows, columns = (side // 2 for side in plane.shape)
        halved = np.ascontiguousarray(plane[: 2 * rows, : 2 * columns])
        plane = np.asarray(
            cv2.resize(halved, (columns, rows), interpolation=cv2.INTER_AREA), np.uint8
        )
    small = cv2.resize(plane, (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.uint8)


def registered(before: Image, now: Image, expected: Floats) -> Floats:
    """(x, y), px: how far the picture moved from one thumbnail to the next.

    Args:
        before: (h, w) uint8.
        now: the same size.
        expected: (x, y), px: taken instead where the picture itself does not tell, or (0, 0) if
            that fits better.
    """
    window = _taper(now.shape)
    # Copies: OpenCV multiplies what it is given by the window, in place.
    one, other = before.astype(np.float32), now.astype(np.float32)
    measured = np.array(cv2.phaseCorrelate(one, other, window)[0])
    still = np.zeros(2)
    if not np.isfinite(measured).all():  # as of pictures without any detail
        return still
    if any(np.array_equal(np.rint(measured), np.rint(way)) for way in (still, expected)):
        return measured
    by_expected, by_still = (_left_over(before, now, way) for way in (expected, still))
    enough = EgoMotionConfig().better * min(by_expected, by_still)
    if _left_over(before, now, measured) < enough:
        return measured
    return expected if by_expected < by_still else still


@cache
def _taper(shape: tuple[int, ...]) -> NDArray[np.float32]:
    """Hann window of a thumbnail's shape (h, w): the same in every frame of a stream."""
    return np.asarray(cv2.createHanningWindow(shape[::-1], cv2.CV_32F), np.float32)


def _left_over(before: Image, now: Image, way: Floats) -> float:
    """Mean difference of two thumbnails where they overlap, ``before`` moved by whole px."""
    height, width = now.shape
    if abs(way[0]) > width / 2 or abs(way[1]) > height / 2:
        return np.inf
    x, y = round(way[0]), round(way[1])
    there = now[max(0, y) : height + min(0, y), max(0, x) : width + min(0, x)]
    here = before[max(0, -y) : height + min(0, -y), max(0, -x) : width + min(0, -x)]
    return float(cv2.mean(cv2.absdiff(there, here))[0])
