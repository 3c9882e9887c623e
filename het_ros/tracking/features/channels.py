# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pixels of the search window to a stack of feature channels, in colour or gray."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
Plane = NDArray[np.float32]


@dataclass(frozen=True)
class ChannelConfig:
    """Constants of the channels.

    Attributes:
        orientations: directions over half a turn (chosen: 30 degrees each, as histograms of
            gradients have about).
        texture_side: side of the square that a deviation is taken from, px (chosen).
        texture_scale: channel values per gray value of deviation (chosen: deviations seldom
            exceed 64, so they fill a byte).
        gradient_scale: channel values per normalised gradient (chosen: these lie in 0..2 or so
            and fill a byte).
        gradient_floor: gray values; gradients far below it are noise, and normalisation does not
            raise them (chosen).
        colour_samples: rows, and as many columns, about, of an image that are looked at for
            colour (chosen: enough).
    """

    orientations: int = 6
    texture_side: int = 11
    texture_scale: float = 4.0
    gradient_scale: float = 80.0
    gradient_floor: float = 4.0
    colour_samples: int = 64

    @property
    def below_half_turn(self) -> float:
        """The last angle before half a turn, in steps between directions."""
        return float(np.nextafter(np.float32(self.orientations), np.float32(0)))


_CONFIG = ChannelConfig()


def is_colourless(image: Pixels, below: float) -> bool:
    """Whether an image is gray, in one channel or in three that say the same.

    Args:
        image: (H, W, 3) or (H, W) uint8.
        below: three channels count as gray where the highest and the lowest value of a pixel are
            less than this apart in the mean; gray values.
    """
    if image.ndim == 2:
        return True
    step = max(1, min(image.shape[:2]) // _CONFIG.colour_samples)
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


def normalised_gradient(lightness: Pixels, cell: int) -> tuple[Plane, Plane]:
    """Gradient's locally normalised magnitude and its direction in [0, orientations).

    Divided by the mean magnitude around, a gradient says the same under a lamp and in the shade.
    cv2.magnitude gives other last bits from process to process; the square root of a whole
    number below 2^24 is rounded the same way everywhere.

    Args:
        lightness: (H, W) uint8.
        cell: the mean is taken of 4 cells of this side, px, around.

    Returns:
        Two planes (H, W) float32.
    """
    dx = np.asarray(cv2.Sobel(lightness, cv2.CV_32F, 1, 0, ksize=1), np.float32)
    dy = np.asarray(cv2.Sobel(lightness, cv2.CV_32F, 0, 1, ksize=1), np.float32)
    directions = np.asarray(cv2.phase(dx, dy), np.float32)
    directions *= _CONFIG.orientations / math.pi
    # Directions k and k + orientations are the same; the subtraction is exact.
    turned = cv2.threshold(
        directions, _CONFIG.below_half_turn, _CONFIG.orientations, cv2.THRESH_BINARY
    )[1]
    directions -= turned
    np.multiply(dx, dx, out=dx)
    np.multiply(dy, dy, out=dy)
    np.add(dx, dy, out=dx)
    magnitude = np.sqrt(dx, out=dx)
    around = 4 * cell + 1
    mean = np.asarray(cv2.blur(magnitude, (around, around)), np.float32)
    mean += _CONFIG.gradient_floor
    cv2.divide(magnitude, mean, magnitude, scale=_CONFIG.gradient_scale)
    return magnitude, directions


def channel_stack(pixels: Pixels, names: tuple[str, ...], cell: int = 1) -> tuple[Pixels, ...]:
    """Channels of a window by name, averaged over cells.

    Args:
        pixels: (H, W, 3) uint8 BGR or (H, W) uint8.
        names: channels, out of ``CHANNEL_NAMES``.
        cell: side of a cell, px. What does not fill a cell at the right and below is left out.

    Returns:
        C planes of (H // cell, W // cell) uint8. All channels are bytes, so that their integral
        images are whole numbers and exact. At cell 1 a plane may be a view of ``pixels``.
    """
    source = _Source(pixels, cell)
    return tuple(_cells(_TABLE[name][0](source), cell) for name in names)


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


def _cells(plane: NDArray[np.generic], cell: int) -> Pixels:
    """Mean of a plane over cells, as uint8."""
    if cell > 1:
        rows, columns = plane.shape[0] // cell, plane.shape[1] // cell
        whole = np.ascontiguousarray(plane[: rows * cell, : columns * cell])
        plane = np.asarray(cv2.resize(whole, (columns, rows), interpolation=cv2.INTER_AREA))
    if plane.dtype == np.uint8:
        return np.asarray(plane, np.uint8)
    return np.asarray(cv2.convertScaleAbs(np.asarray(plane, np.float32)), np.uint8)


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
        return np.asarray(
            _CONFIG.texture_scale * deviation(self.gray, _CONFIG.texture_side), np.float32
        )

    @cached_property
    def gradient(self) -> tuple[Plane, Plane]:
        """Magnitude and direction, see :func:`normalised_gradient`."""
        return normalised_gradient(self.lightness, self.cell)


def _orientation(k: int) -> Callable[[_Source], Plane]:
    """The part of the gradient that runs along direction k of all over half a turn.

    A gradient is shared between the two directions next to it, in proportion.
    """

    def channel(source: _Source) -> Plane:
        magnitude, direction = source.gradient
        if k == 0:  # which is next to the last one as well
            away = np.minimum(direction, _CONFIG.orientations - direction)
        else:
            away = np.subtract(direction, k)
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
    **{
        f"orientation{k}": (_orientation(k), f"orientation{k}")
        for k in range(_CONFIG.orientations)
    },
}

CHANNEL_NAMES: tuple[str, ...] = tuple(_TABLE)
