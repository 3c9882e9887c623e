# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a target's own pixels went since the last frame.

Score maps say which places look like the target; they do not know that it was next door one frame
ago. Optical flow (pyramidal Lucas-Kanade) of points in its box knows nothing else. Points count
where the flow back leads to where they came from (the forward-backward error of MedianFlow:
Kalal, Mikolajczyk, Matas, 2010), and the median of their ways is the target's. A box holds
background as well, and one beside its target more of it than of the target: where enough points go
another way together than what is around the box, they are the target's and the others are not.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.window import Window

Floats = NDArray[np.float64]
Points = NDArray[np.float32]

_GRID, _CORE = 8, 0.8  # points a side in the box, in this part of it
_RING_GRID, _RING = 6, 1.5  # points a side around the box, on a rectangle so much larger
_PATCH = (11, 11)  # px around a point that are compared
_LEVELS = 2  # of the pyramid above the window itself
_STOP = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 6, 0.1)
_THERE_AND_BACK = 1.0  # px, error of the flow back
_TOGETHER = 0.1  # target sides from the median: farther off a point is not the target's
_FEWEST = 8  # points
_APART = 0.04  # target sides from the way of what is around: it goes another way
_FEWEST_OWN = 13  # points: fewer that go another way may be an arm


def _grid(side: int) -> Floats:
    """(side^2, 2): evenly spaced places (x, y) of a square from -0.5 to 0.5."""
    line = np.linspace(-0.5, 0.5, side)
    return np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)


_IN_BOX = _grid(_GRID) * _CORE
_SQUARE = _grid(_RING_GRID)
_AROUND = _SQUARE[np.abs(_SQUARE).max(axis=1) == 0.5] * _RING
# (N, 2), in units of the box's width and height from its centre.
_PLACES = np.concatenate([_IN_BOX, _AROUND])


@dataclass(frozen=True)
class Sight:
    """A target in a frame.

    Attributes:
        window: search window, places counted in px.
        gray: (H, W) uint8, its pixels.
        box: the target, image px, as it is in the window: turned as that is.
    """

    window: Window
    gray: NDArray[np.uint8]
    box: Box


@dataclass(frozen=True)
class Flow:
    """What the points in a target's box say of it.

    Attributes:
        centre: (x, y) of the target, image px.
        share: of the target's points that agree, 0..1.
    """

    centre: Floats
    share: float


def trace(before: Sight, window: Window, gray: NDArray[np.uint8], moved: Floats) -> Flow | None:
    """Follow the target of the last frame into this frame's window.

    Args:
        before: the target in the last frame.
        window: this frame's search window, places in px.
        gray: (H, W) uint8, its pixels.
        moved: (x, y), image px, how far the target is expected to have moved; flow starts there.

    Returns:
        Where the target went, or None where fewer than 8 points agree.
    """
    inside = len(_IN_BOX)
    start = _points(before)
    scale = np.array(before.window.scale)
    places = before.window.to_image(start.astype(np.float64)) + moved
    guess = window.to_window(places).astype(np.float32)
    there, found = _lucas_kanade(before.gray, gray, start, guess)
    back, returned = _lucas_kanade(gray, before.gray, there, there - (guess - start))
    error = np.hypot(*(back - start).T)
    good = found & returned & (error < _THERE_AND_BACK)
    shifts = there - guess
    side = float(np.sqrt(before.box.area * scale.prod()))
    in_box = shifts[:inside][good[:inside]]
    own = without_background(in_box, shifts[inside:][good[inside:]], side)
    if len(own) < _FEWEST:
        return None
    shift = np.median(own, axis=0)
    agree = np.abs(own - shift).max(axis=1) < _TOGETHER * side
    expected = window.to_window(np.array(before.box.centre) + moved)
    centre = window.to_image(expected + shift)
    background = len(in_box) - len(own)
    return Flow(centre, float(agree.sum() / (inside - background)))


def without_background(shifts: Points, around: Points, side: float) -> Points:
    """Of the ways of the points in a box those that are the target's, or all of them.

    Args:
        shifts: (N, 2) float32, px.
        around: (M, 2) float32, px, of points around the box.
        side: sqrt(w h) of the target, px.
    """
    if len(around) < _FEWEST:
        return shifts
    background = np.median(around, axis=0)
    spread = float(np.median(np.abs(around - background).max(axis=1)))
    apart = np.abs(shifts - background).max(axis=1) > max(_APART * side, 2 * spread)
    own = shifts[apart]
    if len(own) < _FEWEST_OWN:
        return shifts
    together = np.abs(own - np.median(own, axis=0)).max(axis=1) < _TOGETHER * side
    return own if together.sum() >= _FEWEST_OWN else shifts


def _points(sight: Sight) -> Points:
    """(N, 2) float32, window px: those in the target's box, then those around it."""
    box = sight.box
    centre = sight.window.to_window(np.array(box.centre))
    return np.asarray(centre + _PLACES * (box.w, box.h) * np.array(sight.window.scale), np.float32)


def _lucas_kanade(
    first: NDArray[np.uint8], second: NDArray[np.uint8], points: Points, guess: Points
) -> tuple[Points, NDArray[np.bool_]]:
    """Points (N, 2) of ``first`` in ``second``, and (N,) whether they were found."""
    moved, status, _ = cv2.calcOpticalFlowPyrLK(
        first,
        second,
        points[:, None],
        guess[:, None].copy(),  # overwritten
        winSize=_PATCH,
        maxLevel=_LEVELS,
        criteria=_STOP,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
    )
    return np.asarray(moved, np.float32)[:, 0], status[:, 0] > 0
