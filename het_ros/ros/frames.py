# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Frames as they came in, and the short memory of them that late boxes start from."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import cv2
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from het_ros.ros.images import ImageError, Pixels, Reading, array_of
from het_ros.ros.stamps import SECOND

ImageMessage = Image | CompressedImage
MEGABYTE = 1_000_000
JPEG_QUALITY = 95


class Conversion:
    """The pixels of one image, converted once for all nodes that look at it.

    :meth:`close` lets them go, so that the ring keeps the message alone.
    """

    def __init__(self, message: ImageMessage) -> None:
        self._message = message
        self._pixels: dict[Reading, Pixels] = {}
        self._open = True

    def pixels(self, reading: Reading) -> Pixels:
        """The pixels; raises ImageError as :func:`array_of` does."""
        pixels = self._pixels.get(reading)
        if pixels is None:
            pixels = array_of(self._message, reading)
            if self._open:
                self._pixels[reading] = pixels
        return pixels

    def close(self) -> None:
        """Keep nothing from now on."""
        self._open = False
        self._pixels.clear()


@dataclass(frozen=True, eq=False)
class Frame:
    """One image as it came in.

    Attributes:
        message: the image; its pixels are read when they are needed.
        stamp: ns, of its header or of its arrival.
        arrival: s on the monotonic clock.
        shared: its conversion, where several nodes look at it.
    """

    message: ImageMessage
    stamp: int
    arrival: float
    shared: Conversion | None = None

    @property
    def header(self) -> Header:
        """The image's header, which every output of this frame carries."""
        return self.message.header

    @property
    def size(self) -> int:
        """Bytes of data."""
        return len(self.message.data)

    def pixels(self, reading: Reading) -> Pixels:
        """Its image; raises ImageError as :func:`array_of` does."""
        return self.shared.pixels(reading) if self.shared else array_of(self.message, reading)


class FrameRing:
    """The newest frames, bounded in time and in memory.

    Over ``megabytes`` the oldest raw images are kept as JPEG, and after that dropped: a late box
    is then started on an image that is a little worse, which costs less than no start.
    """

    def __init__(self, seconds: float, megabytes: float, reading: Reading | None = None) -> None:
        self.seconds = seconds
        self.megabytes = megabytes
        self._reading = reading or Reading()
        self._frames: deque[Frame] = deque()
        self._size = 0
        self._compressed = 0  # so many of the oldest are JPEG by now

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def newest(self) -> Frame | None:
        """The newest frame, or None before the first; it is kept whatever the bounds."""
        return self._frames[-1] if self._frames else None

    @property
    def span(self) -> float:
        """How much older the oldest frame is than the newest, s."""
        return (self._frames[-1].stamp - self._frames[0].stamp) / SECOND if self._frames else 0.0

    @property
    def size(self) -> int:
        """Bytes of image data that are kept."""
        return self._size

    def add(self, frame: Frame) -> None:
        """Keep a frame that is newer than all others, and let go what is over the bounds."""
        self._frames.append(frame)
        self._size += frame.size
        oldest_stamp = frame.stamp - self.seconds * SECOND
        while len(self._frames) > 1 and self._frames[0].stamp < oldest_stamp:
            self._drop_oldest()
        budget = self.megabytes * MEGABYTE
        while self._size > budget and self._compressed < len(self._frames) - 1:
            self._compress_next()
        while self._size > budget and len(self._frames) > 1:
            self._drop_oldest()

    def nearest(self, stamp: int) -> Frame | None:
        """The frame whose stamp (ns) is nearest; None while there are no frames."""
        return min(self._frames, key=lambda frame: abs(frame.stamp - stamp), default=None)

    def since(self, first: Frame) -> list[Frame]:
        """The frames that are newer than ``first``, in order."""
        return [frame for frame in self._frames if frame.stamp > first.stamp]

    def remove(self, frame: Frame) -> None:
        """Forget one frame, for example because it cannot be read."""
        if frame in self._frames:
            index = self._frames.index(frame)
            del self._frames[index]
            self._size -= frame.size
            self._compressed -= index < self._compressed

    def clear(self) -> None:
        """Forget all."""
        self._frames.clear()
        self._size = self._compressed = 0

    def _drop_oldest(self) -> None:
        self._size -= self._frames.popleft().size
        self._compressed = max(self._compressed - 1, 0)

    def _compress_next(self) -> None:
        index = self._compressed
        self._compressed += 1
        frame = self._frames[index]
        smaller = _as_jpeg(frame, self._reading)
        if smaller is not None and smaller.size < frame.size:
            self._frames[index] = smaller
            self._size -= frame.size - smaller.size


def _as_jpeg(frame: Frame, reading: Reading) -> Frame | None:
    """The frame with its pixels as JPEG; None where it is compressed already or unreadable."""
    if isinstance(frame.message, CompressedImage):
        return None
    try:
        pixels = array_of(frame.message, reading)
    except ImageError:
        return None
    data = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1].tobytes()
    message = CompressedImage(header=frame.header, format="jpeg", data=data)
    return Frame(message, frame.stamp, frame.arrival)
