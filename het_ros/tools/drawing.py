# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Draw an answer into its frame."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tools.results import Row
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import State

Colour = tuple[int, int, int]

STATE_COLOURS: dict[State | None, Colour] = {  # BGR
    State.IDLE: (200, 200, 200),
    State.TRACKING: (80, 220, 60),
    State.COASTING: (0, 170, 255),
    State.LOST: (60, 60, 255),
    None: (200, 120, 200),
}
TRUTH_COLOUR: Colour = (255, 255, 255)
SMALLEST_WIDTH = 640  # px; smaller frames are enlarged, so that the text can be read
ARROW_SECONDS = 0.5  # the arrow ends where the target will be in that time
SUBPIXEL_BITS = 4


def annotate(image: NDArray[np.uint8], row: Row, truth: Box | None) -> NDArray[np.uint8]:
    """Enlarge a frame if it is small and draw box, velocity, state, score and ground truth.

    Args:
        image: (H, W, 3) BGR or (H, W) gray uint8; it is left as it is.
        row: the answer to this frame.
        truth: ground truth, px; drawn as a thin white box.

    Returns:
        (n H, n W, 3) uint8 BGR with a whole n >= 1.
    """
    canvas = image if image.ndim == 3 else cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)
    scale = -(-SMALLEST_WIDTH // canvas.shape[1])
    size = canvas.shape[1] * scale, canvas.shape[0] * scale
    canvas = (
        cv2.resize(canvas, size, interpolation=cv2.INTER_LINEAR) if scale > 1 else canvas.copy()
    )
    colour = STATE_COLOURS[row.state]
    if truth:
        _rectangle(canvas, truth, scale, TRUTH_COLOUR, 1)
    if row.box:
        _rectangle(canvas, row.box, scale, colour, 2)
        if row.velocity:
            _arrow(canvas, row.box, row.velocity, scale, colour)
    _caption(canvas, row, colour)
    return canvas


def _rectangle(
    canvas: NDArray[np.uint8], box: Box, scale: int, colour: Colour, thickness: int
) -> None:
    first = _fixed_point(box.x * scale, box.y * scale)
    last = _fixed_point((box.x + box.w) * scale, (box.y + box.h) * scale)
    cv2.rectangle(canvas, first, last, colour, thickness, cv2.LINE_AA, SUBPIXEL_BITS)


def _arrow(
    canvas: NDArray[np.uint8], box: Box, velocity: tuple[float, float], scale: int, colour: Colour
) -> None:
    cx, cy = box.centre
    tip = cx + velocity[0] * ARROW_SECONDS, cy + velocity[1] * ARROW_SECONDS
    start, end = (_fixed_point(x * scale, y * scale) for x, y in ((cx, cy), tip))
    cv2.arrowedLine(canvas, start, end, colour, 2, cv2.LINE_AA, SUBPIXEL_BITS, 0.2)


def _fixed_point(x: float, y: float) -> tuple[int, int]:
    """Corner convention (0 = left edge of the first pixel) to OpenCV's (0 = its middle)."""
    one = 1 << SUBPIXEL_BITS
    return round((x - 0.5) * one), round((y - 0.5) * one)


def _caption(canvas: NDArray[np.uint8], row: Row, colour: Colour) -> None:
    text = row.state.value if row.state else "NO ANSWER"
    if row.score is not None:
        text += f"  score {row.score:.2f}"
    if row.velocity:
        text += f"  {np.hypot(*row.velocity):.0f} px/s"
    write_words(canvas, text, colour)


def write_words(
    canvas: NDArray[np.uint8], text: str, colour: Colour, at_top: bool = False
) -> None:
    """Write a line at the lower or upper left, on a dark ground that goes with any image."""
    (width, height), below = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, 0.6, 1)
    base = height + 4 if at_top else canvas.shape[0] - below - 4
    canvas[max(base - height - 4, 0) : base + below + 4, : width + 16] //= 4
    cv2.putText(canvas, text, (8, base), cv2.FONT_HERSHEY_SIMPLEX, 0.6, colour, 1, cv2.LINE_AA)
