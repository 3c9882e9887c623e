# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One camera image for several browsers, each in the size that its window needs."""

from __future__ import annotations

import threading
import time
from typing import Any

import cv2
from sensor_msgs.msg import CompressedImage, Image

from het_ros.operator.messages import image_message
from het_ros.ros.image_size import claimed_size
from het_ros.ros.images import LONGEST_HEADER, MOST_PIXELS, Pixels, array_of
from het_ros.ros.messages import stamp_ns

LIVE = 60.0  # s: an image stamped further from now comes from a bag; it is as old as its arrival
STEP = 32  # px: widths are rounded to it, so that browsers of about one size share the work
ENOUGH = 1.5  # a JPEG that is wider than asked for by less than this goes out as it is


class Picture:
    """A camera's image; it is encoded on demand, once for each size and quality.

    Args:
        message: the image.
        number: it is the so manyth that the camera sent, which tells how many a browser missed.
        now: s since 1970, on arrival.
    """

    def __init__(self, message: Image | CompressedImage, number: int, now: float = 0.0) -> None:
        now = now or time.time()
        self.stamp = stamp_ns(message.header)
        self.number = number
        age = now - self.stamp * 1e-9
        self._captured = self.stamp * 1e-9 if abs(age) < LIVE else now
        self._message = message
        self._lock = threading.Lock()
        self._pixels: Pixels | None = None
        self._made: dict[tuple[int, int], bytes] = {}

    def encoded(self, width: int, quality: int) -> bytes:
        """The socket's message with a JPEG about ``width`` px wide, never wider than the image.

        Raises:
            ImageError: the image cannot be read.
        """
        key = (max(width // STEP, 1) * STEP, quality)
        with self._lock:
            if key not in self._made:
                self._made[key] = self._encode(*key)
            return self._made[key]

    def _encode(self, width: int, quality: int) -> bytes:
        size, data = _jpeg(self._message)
        if not data or size[0] > ENOUGH * width:
            if self._pixels is None:
                self._pixels = array_of(self._message)
            pixels = self._pixels
            size = pixels.shape[1], pixels.shape[0]
            if width < size[0]:
                height = max(round(size[1] * width / size[0]), 1)
                pixels = cv2.resize(pixels, (width, height), interpolation=cv2.INTER_AREA)
            data = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()
        header: dict[str, Any] = {
            "stamp": str(self.stamp),
            "captured": self._captured,
            "number": self.number,
            "size": size,
        }
        return image_message(header, data)


def _jpeg(message: Image | CompressedImage) -> tuple[tuple[int, int], bytes]:
    """Size (width, height) px and bytes of an image that is a whole JPEG; else no bytes."""
    if not isinstance(message, CompressedImage) or message.data[:2].tobytes() != b"\xff\xd8":
        return (0, 0), b""
    data = message.data.tobytes()
    size = claimed_size(data[:LONGEST_HEADER])
    whole = data.rfind(b"\xff\xd9", -1024) >= 0
    if size is None or size[0] * size[1] > MOST_PIXELS or not whole:
        return (0, 0), b""
    return size, data
