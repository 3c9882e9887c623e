"""Compressive features of sub-patches, as dense maps over the search window.

All sub-patches have one size and share one measurement matrix. So a compressive feature is one map
over the window, its value at (x, y) being that of a sub-patch whose corner is there, and every
sub-patch reads the same maps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

Integrals = Sequence[NDArray[Any]]
Features = NDArray[np.floating[Any]]


class Rectangle(NamedTuple):
    """One rectangle filter: the sum of a channel over [x0, x1) x [y0, y1) times ``sign``."""

    channel: int
    x0: int
    y0: int
    x1: int
    y1: int
    sign: int


@dataclass(frozen=True)
class MeasurementMatrix:
    """The sparse random matrix R (eq. random metrix), fixed at the first frame.

    A row holds the rectangle filters with which it has a non-zero entry, 2 to Z of them (fewer if
    Z is 1) as in Compressive Tracking, all in one channel. The common factor sqrt(p) of all
    entries is left out: features are scaled by their own deviation.

    Attributes:
        size: (w, h) of a sub-patch, px; every rectangle lies inside it.
        rows: m rows of rectangles.
    """

    size: tuple[int, int]
    rows: tuple[tuple[Rectangle, ...], ...]


def draw_measurement_matrix(
    size: tuple[int, int],
    channels: int,
    features: int,
    rectangles: int,
    rng: np.random.Generator,
    largest: float = 1.0,
) -> MeasurementMatrix:
    """Draw R for sub-patches of ``size``.

    Args:
        size: (w, h) of a sub-patch, px.
        channels: C, number of channels.
        features: m, number of rows.
        rectangles: Z, most rectangles of a row.
        rng: where everything is drawn from.
        largest: longest side of a rectangle over the sub-patch's side, 0..1. Small rectangles
            tell places apart that differ by little.
    """
    width, height = size
    widest, highest = (max(1, round(largest * side)) for side in size)
    rows = []
    for _ in range(features):
        channel = int(rng.integers(channels))
        count = int(rng.integers(min(2, rectangles), rectangles, endpoint=True))
        row = []
        for _ in range(count):
            x0, y0 = int(rng.integers(width)), int(rng.integers(height))
            x1 = int(rng.integers(x0 + 1, min(width, x0 + widest), endpoint=True))
            y1 = int(rng.integers(y0 + 1, min(height, y0 + highest), endpoint=True))
            row.append(Rectangle(channel, x0, y0, x1, y1, 1 if rng.integers(2) else -1))
        rows.append(tuple(row))
    return MeasurementMatrix(size, tuple(rows))


def integral_images(channels: Sequence[NDArray[Any]]) -> list[NDArray[Any]]:
    """Integral image of each channel (H, W): (H + 1, W + 1), exact int32 for uint8 channels."""
    return [np.asarray(cv2.integral(np.ascontiguousarray(channel))) for channel in channels]


def raw_feature_maps(
    integrals: Integrals, matrix: MeasurementMatrix, buffer: NDArray[Any] | None = None
) -> NDArray[Any]:
    """L = R H (eq. 1) for the sub-patches at all places of a window.

    Args:
        integrals: C integral images (H + 1, W + 1) of one dtype, contiguous.
        matrix: R, with sub-patches of (w, h).
        buffer: an array of this function that may be overwritten.

    Returns:
        (m, H - h + 1, W - w + 1) of the integrals' dtype: the features of the sub-patches with
        their corners at column x and row y; a view of an array that can be the next ``buffer``.
    """
    width, height = matrix.size
    stride = integrals[0].shape[1]
    rows = integrals[0].shape[0] - height
    shape = (len(matrix.rows), rows, stride)
    if buffer is None or buffer.shape != shape or buffer.dtype != integrals[0].dtype:
        buffer = np.empty(shape, integrals[0].dtype)
    # Maps and integral images are read as flat arrays with the same stride: slices of those are
    # contiguous and several times faster than slices of rows and columns. What comes of places
    # from column W - w + 1 on runs over the border and is cut off at the end.
    places = rows * stride - width
    flat = [integral.reshape(-1) for integral in integrals]
    band = np.empty(places + width, buffer.dtype)
    for feature, rectangles in zip(buffer.reshape(len(buffer), -1), matrix.rows, strict=True):
        total = feature[:places]
        started = False
        for channel, x0, y0, x1, y1, sign in rectangles:
            # First the sums over all rows of the rectangle, then between two columns of them.
            integral, span = flat[channel], places + x1 - x0
            upper, lower = y0 * stride + x0, y1 * stride + x0
            np.subtract(
                integral[lower : lower + span], integral[upper : upper + span], out=band[:span]
            )
            left, right = band[:places], band[x1 - x0 : span]
            plus, minus = (right, left) if sign > 0 else (left, right)
            if started:
                np.add(total, plus, out=total)
                np.subtract(total, minus, out=total)
            else:
                np.subtract(plus, minus, out=total)
                started = True
    return buffer[:, :, : stride - width]


class CompressiveFeatures:
    """Feature maps, centred and scaled by what the first frame's features were like.

    Without that the squares of sums over thousands of pixels would cancel each other's digits.
    The maps live in buffers that are used again: they hold until the next call.

    Args:
        matrix: R.
        dtype: of the maps. In float32 scores are good to some 1e-5 of the largest.
    """

    def __init__(self, matrix: MeasurementMatrix, dtype: type[np.floating[Any]] = np.float64):
        self.matrix = matrix
        self._dtype = dtype
        self._centre: NDArray[Any] | None = None
        self._scale = np.ones((len(matrix.rows), 1, 1), dtype)
        self._buffer: NDArray[Any] | None = None
        self._maps: Features = np.empty((0, 0, 0), dtype)

    def maps(self, integrals: Integrals) -> Features:
        """(m, rows, columns) of the standardised features at every place of a window.

        The first call fixes, for each feature, the mean and the deviation that this and all
        further maps are centred and scaled with.

        Args:
            integrals: C integral images (H + 1, W + 1) of one dtype, contiguous.
        """
        raw = raw_feature_maps(integrals, self.matrix, self._buffer)
        self._buffer = raw.base
        if self._centre is None:
            self._centre = self._fit(raw)
        if self._maps.shape != raw.shape:
            self._maps = np.empty(raw.shape, self._dtype)
        # Centred first, where whole numbers are still exact.
        np.subtract(raw, self._centre, out=self._maps, casting="unsafe")
        self._maps *= self._scale
        return self._maps

    def _fit(self, raw: NDArray[Any]) -> NDArray[Any]:
        """Take the scale from raw maps (m, rows, columns) and return the centre (m, 1, 1)."""
        deviation = raw.std(axis=(1, 2), keepdims=True)
        # A feature that is flat in the first frame is left in grey values per pixel.
        area = self.matrix.size[0] * self.matrix.size[1]
        self._scale = (1 / np.where(deviation > 0, deviation, area)).astype(self._dtype)
        return np.asarray(np.rint(raw.mean(axis=(1, 2), keepdims=True)).astype(raw.dtype))
