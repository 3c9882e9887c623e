# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Images without colour: how they are told, and what is read of them instead of colours."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
Plane = NDArray[np.float32]

_SAMPLES = 64  # rows of an image that are looked at, and as many columns, about


def is_colourless(image: Pixels, below: float) -> bool:
    """Whether an image is gray, in one channel or in three that say the same.

    Args:
        image: (H, W, 3) or (H, W) uint8.
        below: three channels count as gray where the highest and the lowest value of a pixel are
            less than this apart in the mean; gray values.
    """
    if image.ndim == 2:
        return True
    step = max(1, min(image.shape[:2]) // _SAMPLES)
    some = image[::step, ::step].astype(np.int16)
    return float((some.max(axis=2) - some.min(axis=2)).mean()) < below


def gray_of(pixels: Pixels) -> Pixels:
    """(H, W) uint8 of pixels (H, W, 3) BGR or (H, W)."""
    if pixels.ndim == 2:
        return pixels
    return np.asarray(cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY), np.uint8)


def bgr_of(pixels: Pixels) -> Pixels:
    """(H, W, 3) uint8 of pixels (H, W, 3) BGR or (H, W)."""
    if pixels.ndim == 3:
        return pixels
    return np.asarray(cv2.cvtColor(pixels, cv2.COLOR_GRAY2BGR), np.uint8)


def deviation(gray: Pixels, side: int) -> Plane:
    """Standard deviation (H, W) float32 of the gray values in a square around each pixel.

    Args:
        gray: (H, W) uint8.
        side: of the square, px.
    """
    mean = cv2.blur(gray.astype(np.float32), (side, side))
    squares = cv2.sqrBoxFilter(gray, cv2.CV_32F, (side, side))
    return np.sqrt(np.maximum(squares - mean * mean, 0))
