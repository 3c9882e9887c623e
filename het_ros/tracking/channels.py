"""Pixels of the search window to a stack of feature channels."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]


class _Source:
    """One window's pixels and what channels share, each computed once when first asked for."""

    def __init__(self, pixels: Pixels) -> None:
        self.pixels = pixels

    @cached_property
    def bgr(self) -> Pixels:
        """(H, W, 3) uint8; a gray image three times."""
        return _as_bgr(self.pixels)

    @cached_property
    def gray(self) -> Pixels:
        """(H, W) uint8."""
        return _as_gray(self.pixels)


def _as_bgr(pixels: Pixels) -> Pixels:
    if pixels.ndim == 3:
        return pixels
    return np.asarray(cv2.cvtColor(pixels, cv2.COLOR_GRAY2BGR), dtype=np.uint8)


def _as_gray(pixels: Pixels) -> Pixels:
    if pixels.ndim == 2:
        return pixels
    return np.asarray(cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY), dtype=np.uint8)


# name -> (channel, name that a gray image takes instead or None where it has no such channel)
_TABLE: dict[str, tuple[Callable[[_Source], NDArray[np.generic]], str | None]] = {
    "gray": (lambda source: source.gray, "gray"),
    "b": (lambda source: source.bgr[..., 0], "gray"),
    "g": (lambda source: source.bgr[..., 1], "gray"),
    "r": (lambda source: source.bgr[..., 2], "gray"),
}

CHANNEL_NAMES: tuple[str, ...] = tuple(_TABLE)


def names_for(names: tuple[str, ...], image: NDArray[np.uint8]) -> tuple[str, ...]:
    """The channels that a target gets which starts on ``image``.

    Colour says nothing in a gray image, so ("b", "g", "r") becomes ("gray",) there. Later images
    of the same track may be of the other kind: they are converted.

    Args:
        names: channels by name.
        image: (H, W, 3) or (H, W) uint8.
    """
    if image.ndim == 3:
        return names
    instead = (_TABLE[name][1] for name in names)
    return tuple(dict.fromkeys(name for name in instead if name is not None)) or ("gray",)


def channel_stack(pixels: Pixels, names: tuple[str, ...]) -> tuple[NDArray[np.generic], ...]:
    """Channels of a window by name.

    Args:
        pixels: (H, W, 3) uint8 BGR or (H, W) uint8.
        names: channels, out of ``CHANNEL_NAMES``.

    Returns:
        C planes of (H, W), uint8 for the channels of colour.
    """
    source = _Source(pixels)
    return tuple(_TABLE[name][0](source) for name in names)
