# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Boxes on images: one colour a tracker, the truth in white."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
Colour = tuple[int, int, int]
TRUTH: Colour = (255, 255, 255)
LINE = 18  # height of a line of text, px

# Ten colours that stay apart for most eyes, R, G, B; the first is for the tracker of interest.
_PALETTE = [
    (230, 25, 25), (30, 110, 220), (20, 150, 60), (240, 140, 0), (130, 60, 190),
    (0, 170, 190), (220, 60, 160), (130, 130, 20), (120, 80, 50), (90, 90, 90),
]  # fmt: skip


def colours(names: Sequence[str]) -> dict[str, Colour]:
    """A colour (R, G, B) for each tracker, in their order; repeated after ten."""
    return {name: _PALETTE[i % len(_PALETTE)] for i, name in enumerate(names)}


def draw_boxes(
    image: Image,
    boxes: Mapping[str, NDArray[np.float64]],
    palette: Mapping[str, Colour],
    truth: NDArray[np.float64] | None = None,
    scale: float = 1.0,
) -> Image:
    """A copy of ``image``, (H, W, 3) BGR, enlarged by ``scale``, with boxes x, y, w, h drawn.

    The first box lies on top of the others.
    """
    size = round(image.shape[1] * scale), round(image.shape[0] * scale)
    canvas = np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_LINEAR), np.uint8)
    if truth is not None:
        _rectangle(canvas, truth * scale, TRUTH, 3)
        _rectangle(canvas, truth * scale, (0, 0, 0), 1)
    for name, box in reversed(list(boxes.items())):
        _rectangle(canvas, box * scale, palette[name], 2)
    return canvas


def draw_label(image: Image, text: str, line: int = 0, colour: Colour = TRUTH) -> None:
    """Write ``text`` on the given line from the top left, in place, on a dark ground."""
    font, size = cv2.FONT_HERSHEY_SIMPLEX, 0.45
    (width, _), _ = cv2.getTextSize(text, font, size, 1)
    top = LINE * line
    ground = image[top : top + LINE, : width + 10]
    ground[:] = ground // 4
    light = tuple(min(255, value + 70) for value in colour[::-1])
    cv2.putText(image, text, (5, top + LINE - 5), font, size, light, 1, cv2.LINE_AA)


def _rectangle(image: Image, box: NDArray[np.float64], colour: Colour, thickness: int) -> None:
    if not np.isfinite(box).all():
        return
    limits = np.clip([box[0], box[1], box[0] + box[2], box[1] + box[3]], -10_000, 10_000)
    x0, y0, x1, y1 = (round(float(value)) for value in limits)
    cv2.rectangle(image, (x0, y0), (x1, y1), colour[::-1], thickness, cv2.LINE_AA)
