# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Write an MP4 that browsers play: H.264, 4:2:0, index in front."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

CLOCK = Fraction(1, 90_000)  # s, the usual time base of MP4 video
QUALITY = "23"  # x264's constant rate factor


class VideoWriter:
    """An MP4 file to which frames are added with their stamps; whole again after every exit.

    Frames are shown at their own stamps, so a stream with gaps plays at its true speed.

    Args:
        path: file to write; it is replaced if it exists.
        rate: usual frames/s, which the encoder plans for.
    """

    def __init__(self, path: Path | str, rate: float) -> None:
        self._container = av.open(str(path), "w", options={"movflags": "+faststart"})
        self._stream = self._container.add_stream(
            "libx264", rate=Fraction(rate).limit_denominator(1001)
        )
        self._stream.pix_fmt = "yuv420p"
        self._stream.options = {"crf": QUALITY, "preset": "veryfast"}
        self._stream.codec_context.time_base = CLOCK
        self._first_stamp: int | None = None
        self._last_time = -1

    def __enter__(self) -> VideoWriter:
        return self

    def __exit__(self, *_: object) -> None:
        if self._first_stamp is not None:
            self._container.mux(self._stream.encode(None))
        self._container.close()

    def add(self, image: NDArray[np.uint8], stamp: int) -> None:
        """Add a frame.

        Args:
            image: (H, W, 3) uint8 BGR; an odd last row or column is left out, and a frame of
                another size than the first is scaled to it.
            stamp: its time, ns; not later than the one before means right after that one.
        """
        height, width = image.shape[0] & ~1, image.shape[1] & ~1
        if self._first_stamp is None:
            self._first_stamp = stamp
            self._stream.width, self._stream.height = width, height
        frame = av.VideoFrame.from_ndarray(image[:height, :width], format="bgr24")
        if (width, height) != (self._stream.width, self._stream.height):
            frame = frame.reformat(width=self._stream.width, height=self._stream.height)
        time = round((stamp - self._first_stamp) * 1e-9 / CLOCK)
        self._last_time = max(time, self._last_time + 1)
        frame.pts, frame.time_base = self._last_time, CLOCK
        self._container.mux(self._stream.encode(frame))
