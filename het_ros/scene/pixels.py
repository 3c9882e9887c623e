# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Laying pictures with soft edges into an image.

A cut-out is (h, w, 4) uint8: BGR already multiplied by its alpha, then alpha.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

Window = tuple[slice, slice]


@dataclass(frozen=True, eq=False)
class Piece:
    """A cut-out with its place.

    Attributes:
        picture: (h, w, 4) uint8.
        column, row: its corner in the image, px; it may lie outside.
        depth: its distance in front of the camera, m: what is nearer hides it.
    """

    picture: np.ndarray
    column: int
    row: int
    depth: float


def cut_out(bgr: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    """Cut-out from a picture (h, w, 3), 0..255, and its alpha (h, w), 0..1."""
    alpha = np.clip(alpha, 0, 1)
    colour = np.clip(bgr, 0, 255) * alpha[..., None]
    return np.dstack([colour, alpha * 255]).round().astype(np.uint8)


def pyramid(picture: np.ndarray, smallest: int = 4) -> list[np.ndarray]:
    """The picture and its halves, down to a side of ``smallest`` px."""
    levels = [picture]
    while min(levels[-1].shape[:2]) >= 2 * smallest:
        height, width = levels[-1].shape[:2]
        half = (max(width // 2, 1), max(height // 2, 1))
        levels.append(cv2.resize(levels[-1], half, interpolation=cv2.INTER_AREA))
    return levels


def lay(image: np.ndarray, piece: np.ndarray, column: int, row: int) -> None:
    """Lay a cut-out over an image, in place, its corner at (column, row) px."""
    window, inner = overlap(image.shape, piece.shape, column, row)
    if window is None:
        return
    piece = piece[inner]
    through = cv2.cvtColor(cv2.bitwise_not(piece[..., 3]), cv2.COLOR_GRAY2BGR)
    beneath = cv2.multiply(image[window], through, scale=1 / 255)
    cv2.add(beneath, np.ascontiguousarray(piece[..., :3]), dst=beneath)
    image[window] = beneath


def lay_over(canvas: np.ndarray, piece: np.ndarray, column: int, row: int) -> None:
    """Lay a cut-out over a cut-out, in place (both with alpha)."""
    window, inner = overlap(canvas.shape, piece.shape, column, row)
    if window is None:
        return
    piece = np.ascontiguousarray(piece[inner])
    alpha = cv2.bitwise_not(piece[..., 3])
    beneath = cv2.multiply(canvas[window], cv2.merge([alpha] * 4), scale=1 / 255)
    canvas[window] = cv2.add(beneath, piece)


def overlap(
    outer: tuple[int, ...], inner: tuple[int, ...], column: int, row: int
) -> tuple[Window, Window] | tuple[None, None]:
    """The windows of both arrays that meet when ``inner`` lies at (column, row) of ``outer``."""
    left, top = max(column, 0), max(row, 0)
    right, bottom = min(column + inner[1], outer[1]), min(row + inner[0], outer[0])
    if right <= left or bottom <= top:
        return None, None
    window = slice(top, bottom), slice(left, right)
    return window, (slice(top - row, bottom - row), slice(left - column, right - column))


def warp_window(
    picture: np.ndarray, to_image: np.ndarray, left: int, top: int, width: int, height: int
) -> np.ndarray:
    """A window of the image that a plane's picture is warped into.

    Args:
        picture: (h, w, channels) uint8; a cut-out is clear outside its edges, another goes on.
        to_image: (3, 3), picture px to image px, both counted from the corner of the first px.
        left: first column of the window, px.
        top: first row of the window, px.
        width: of the window, px.
        height: of the window, px.
    """
    half = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1.0]])
    shift = np.array([[1, 0, left + 0.5], [0, 1, top + 0.5], [0, 0, 1.0]])
    inverse = np.linalg.inv(half) @ np.linalg.inv(to_image) @ shift
    return cv2.warpPerspective(
        picture,
        inverse,
        (width, height),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_CONSTANT if picture.ndim == 3 and picture.shape[2] == 4
        else cv2.BORDER_REPLICATE,
    )  # fmt: skip
