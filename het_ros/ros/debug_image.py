# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``~/debug_image``: what the tracker sees, for the eyes of a person."""

from __future__ import annotations

import cv2
import numpy as np
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from het_ros.ros.images import Pixels
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Estimate, State

COLOURS = {  # BGR
    State.IDLE: (200, 200, 200),
    State.TRACKING: (80, 220, 60),
    State.COASTING: (0, 190, 255),
    State.LOST: (60, 60, 230),
}
ARROW_SECONDS = 0.5  # the arrow ends where the target will be by then
FIXED_POINT = 4  # fractional bits of drawn coordinates


def drawn(pixels: Pixels, estimate: Estimate | None, state: State, reason: str) -> Pixels:
    """A copy of the image, ``(H, W, 3) uint8``, with the estimate drawn into it.

    Box and words in the state's colour, sub-patches from blue (weight 0) to red (weight 1), and
    an arrow to where the target is half a second later.
    """
    image = cv2.cvtColor(pixels, cv2.COLOR_GRAY2BGR) if pixels.ndim == 2 else pixels.copy()
    words = f"{state.value} {reason}".strip()
    if estimate is not None and state in (State.TRACKING, State.COASTING):
        for patch in sorted(estimate.patches, key=lambda patch: patch.weight):
            _rectangle(image, patch.box, _weight_colour(patch.weight), 1)
        _rectangle(image, estimate.box, COLOURS[state], 2)
        x, y = estimate.box.centre
        ahead = [c + v * ARROW_SECONDS for c, v in zip((x, y), estimate.velocity, strict=True)]
        _arrow(image, (x, y), (ahead[0], ahead[1]), COLOURS[state])
        words = f"{words}  score {estimate.score:.2f}"
    _write(image, words, COLOURS[state])
    return image


def debug_message(image: Pixels, header: Header) -> Image:
    """The drawn image as bgr8."""
    height, width = image.shape[:2]
    return Image(
        header=header,
        height=height,
        width=width,
        encoding="bgr8",
        is_bigendian=False,
        step=3 * width,
        data=image.tobytes(),
    )


def _weight_colour(weight: float) -> tuple[int, ...]:
    value = np.array([[round(255 * min(max(weight, 0.0), 1.0))]], np.uint8)
    return tuple(int(c) for c in cv2.applyColorMap(value, cv2.COLORMAP_JET)[0, 0])


def _fixed(point: tuple[float, float]) -> tuple[int, int]:
    """A corner-counted point for cv2's drawing, which counts from pixel centres, with fractions.

    Far points are pulled in: cv2 takes 32-bit numbers.
    """
    x, y = (min(max(value, -16000.0), 16000.0) - 0.5 for value in point)
    return round(x * 2**FIXED_POINT), round(y * 2**FIXED_POINT)


def _rectangle(image: Pixels, box: Box, colour: tuple[int, ...], thickness: int) -> None:
    first, last = _fixed((box.x, box.y)), _fixed((box.x + box.w, box.y + box.h))
    cv2.rectangle(image, first, last, colour, thickness, cv2.LINE_AA, FIXED_POINT)


def _arrow(
    image: Pixels, tail: tuple[float, float], tip: tuple[float, float], colour: tuple[int, ...]
) -> None:
    cv2.arrowedLine(image, _fixed(tail), _fixed(tip), colour, 2, cv2.LINE_AA, FIXED_POINT, 0.25)


def _write(image: Pixels, words: str, colour: tuple[int, ...]) -> None:
    scale = max(image.shape[0] / 900, 0.4)
    at = (round(10 * scale), round(28 * scale))
    for shade, thickness in (((0, 0, 0), 3), (colour, 1)):
        cv2.putText(
            image, words, at, cv2.FONT_HERSHEY_SIMPLEX, scale, shade, thickness, cv2.LINE_AA
        )
