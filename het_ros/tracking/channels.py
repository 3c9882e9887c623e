# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pixels of the search window to a stack of feature channels."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.gray import Pixels, Plane, bgr_of, deviation, gray_of

ORIENTATIONS = 6
# Deviations of gray values rarely exceed 64; they are taken from a square of this side, px.
_TEXTURE_SCALE = 4.0
_TEXTURE_SIDE = 11
# Normalised gradients lie in 0..2 or so; times this they fill a byte.
_GRADIENT_SCALE = 80.0
# Gradients far below this many grey values are noise and are not blown up by normalisation.
_GRADIENT_FLOOR = 4.0
_BELOW_HALF_TURN = float(np.nextafter(np.float32(ORIENTATIONS), np.float32(0)))


class _Source:
    """One window's pixels and what channels share, each computed once when first asked for."""

    def __init__(self, pixels: Pixels, cell: int) -> None:
        self.pixels = pixels
        self.cell = cell

    @cached_property
    def bgr(self) -> Pixels:
        """(H, W, 3) uint8; a gray image three times."""
        return bgr_of(self.pixels)

    @cached_property
    def gray(self) -> Pixels:
        """(H, W) uint8."""
        return gray_of(self.pixels)

    @cached_property
    def lab(self) -> Pixels:
        """(H, W, 3) uint8, CIE L*a*b*."""
        return np.asarray(cv2.cvtColor(self.bgr, cv2.COLOR_BGR2LAB), np.uint8)

    @cached_property
    def lightness(self) -> Pixels:
        """(H, W) uint8, L* of a colour image or the gray image itself."""
        return self.pixels if self.pixels.ndim == 2 else np.ascontiguousarray(self.lab[..., 0])

    @property
    def texture(self) -> Plane:
        """(H, W) float32, how much the gray values around each pixel differ."""
        return np.asarray(_TEXTURE_SCALE * deviation(self.gray, _TEXTURE_SIDE), np.float32)

    @cached_property
    def gradient(self) -> tuple[Plane, Plane]:
        """Gradient's locally normalised magnitude and its direction in [0, ORIENTATIONS).

        Divided by the mean magnitude around, a gradient says the same under a lamp and in the
        shade. Both (H, W) float32.
        """
        dx = cv2.Sobel(self.lightness, cv2.CV_32F, 1, 0, ksize=1)
        dy = cv2.Sobel(self.lightness, cv2.CV_32F, 0, 1, ksize=1)
        magnitude, angle = cv2.cartToPolar(dx, dy)
        around = 4 * self.cell + 1
        mean = np.asarray(cv2.blur(magnitude, (around, around)), np.float32)
        mean += _GRADIENT_FLOOR
        cv2.divide(magnitude, mean, magnitude, scale=_GRADIENT_SCALE)
        directions = np.asarray(angle, np.float32)
        directions *= ORIENTATIONS / math.pi
        # Directions k and k + ORIENTATIONS are the same; the subtraction is exact.
        turned = cv2.threshold(directions, _BELOW_HALF_TURN, ORIENTATIONS, cv2.THRESH_BINARY)[1]
        directions -= turned
        return np.asarray(magnitude, np.float32), directions


def _orientation(k: int) -> Callable[[_Source], Plane]:
    """The part of the gradient that runs along direction k of ORIENTATIONS over half a turn.

    A gradient is shared between the two directions next to it, in proportion.
    """

    def channel(source: _Source) -> Plane:
        magnitude, angle = source.gradient
        if k == 0:  # which is next to the last one as well
            away = np.minimum(angle, ORIENTATIONS - angle)
        else:
            away = np.subtract(angle, k)
            np.abs(away, out=away)
        np.subtract(1, away, out=away)
        np.maximum(away, 0, out=away)
        away *= magnitude
        return np.asarray(away, np.float32)

    return channel


# name -> (channel, name that a gray image takes instead or None where it has no such channel)
_TABLE: dict[str, tuple[Callable[[_Source], NDArray[np.generic]], str | None]] = {
    "gray": (lambda source: source.gray, "gray"),
    "b": (lambda source: source.bgr[..., 0], "gray"),
    "g": (lambda source: source.bgr[..., 1], "gray"),
    "r": (lambda source: source.bgr[..., 2], "gray"),
    "lightness": (lambda source: source.lightness, "lightness"),
    "green_red": (lambda source: source.lab[..., 1], "texture"),
    "blue_yellow": (lambda source: source.lab[..., 2], None),
    "texture": (lambda source: source.texture, "texture"),
    "gradient": (lambda source: source.gradient[0], "gradient"),
    **{f"orientation{k}": (_orientation(k), f"orientation{k}") for k in range(ORIENTATIONS)},
}

CHANNEL_NAMES: tuple[str, ...] = tuple(_TABLE)


def names_for(names: tuple[str, ...], gray: bool) -> tuple[str, ...]:
    """The channels that a target gets.

    Colour says nothing in a gray image, so ("b", "g", "r") becomes ("gray",) there, and texture
    takes the place of green_red.

    Args:
        names: channels by name.
        gray: whether its images are without colour.
    """
    if not gray:
        return names
    instead = (_TABLE[name][1] for name in names)
    return tuple(dict.fromkeys(name for name in instead if name is not None)) or ("gray",)


def channel_stack(pixels: Pixels, names: tuple[str, ...], cell: int = 1) -> tuple[Pixels, ...]:
    """Channels of a window by name, averaged over cells.

    Args:
        pixels: (H, W, 3) uint8 BGR or (H, W) uint8.
        names: channels, out of ``CHANNEL_NAMES``.
        cell: side of a cell, px. What does not fill a cell at the right and below is left out.

    Returns:
        C planes of (H // cell, W // cell) uint8. All channels are bytes, so that their integral
        images are whole numbers and exact.
    """
    source = _Source(pixels, cell)
    return tuple(_cells(_TABLE[name][0](source), cell) for name in names)


def _cells(plane: NDArray[np.generic], cell: int) -> Pixels:
    """Mean of a plane over cells, as uint8."""
    if cell > 1:
        rows, columns = plane.shape[0] // cell, plane.shape[1] // cell
        whole = np.ascontiguousarray(plane[: rows * cell, : columns * cell])
        plane = np.asarray(cv2.resize(whole, (columns, rows), interpolation=cv2.INTER_AREA))
    if plane.dtype == np.uint8:
        return np.asarray(plane, np.uint8)
    return np.asarray(cv2.convertScaleAbs(np.asarray(plane, np.float32)), np.uint8)
