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
Features = NDArray[np.float32]


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
    size: tuple[int, int], channels: int, features: int, rectangles: int, rng: np.random.Generator
) -> MeasurementMatrix:
    """Draw R for sub-patches of ``size``.

    Args:
        size: (w, h) of a sub-patch, px.
        channels: C, number of channels.
        features: m, number of rows.
        rectangles: Z, most rectangles of a row.
        rng: where everything is drawn from.
    """
    width, height = size
    rows = []
    for _ in range(features):
        channel = int(rng.integers(channels))
        count = int(rng.integers(min(2, rectangles), rectangles, endpoint=True))
        row = []
        for _ in range(count):
            x0, y0 = int(rng.integers(width)), int(rng.integers(height))
            x1 = int(rng.integers(x0 + 1, width, endpoint=True))
            y1 = int(rng.integers(y0 + 1, height, endpoint=True))
            row.append(Rectangle(channel, x0, y0, x1, y1, 1 if rng.integers(2) else -1))
        rows.append(tuple(row))
    return MeasurementMatrix(size, tuple(rows))


def integral_images(channels: Sequence[NDArray[Any]]) -> list[NDArray[Any]]:
    """Integral image of each channel (H, W): (H + 1, W + 1), exact int32 for uint8 channels."""
    return [np.asarray(cv2.integral(np.ascontiguousarray(channel))) for channel in channels]


def raw_feature_maps(
    integrals: Integrals, matrix: MeasurementMatrix, out: NDArray[Any], step: int = 1
) -> None:
    """L = R H (eq. 1) for the sub-patches at all places of a window.

    Args:
        integrals: C integral images (H + 1, W + 1) of one dtype.
        matrix: R, with sub-patches of (w, h).
        out: (m, rows, columns) of the integrals' dtype, rows = (H - h) // step + 1 and columns =
            (W - w) // step + 1; filled with the features of the sub-patches with their corners
            at (x, y) = (step column, step row).
        step: distance of two places, px.
    """
    _, rows, columns = out.shape
    span_y, span_x = step * (rows - 1) + 1, step * (columns - 1) + 1
    band = np.empty((rows, integrals[0].shape[1]), out.dtype)
    for feature, rectangles in zip(out, matrix.rows, strict=True):
        started = False
        for channel, x0, y0, x1, y1, sign in rectangles:
            # The sum over a band of rows first, then between two columns of it.
            integral = integrals[channel]
            width = x1 - x0 + span_x
            upper = integral[y0 : y0 + span_y : step, x0 : x0 + width]
            lower = integral[y1 : y1 + span_y : step, x0 : x0 + width]
            sums = np.subtract(lower, upper, out=band[:, :width])
            left, right = sums[:, :span_x:step], sums[:, x1 - x0 :: step]
            if not started:
                plus, minus = (right, left) if sign > 0 else (left, right)
                np.subtract(plus, minus, out=feature)
                started = True
            elif sign > 0:
                feature += right
                feature -= left
            else:
                feature -= right
                feature += left


class CompressiveFeatures:
    """Feature maps, centred and scaled by what the first frame's features were like.

    Without that the squares of sums over thousands of pixels would cancel in float32.
    The maps live in buffers that are used again: they hold until the next call.
    """

    def __init__(self, matrix: MeasurementMatrix) -> None:
        self.matrix = matrix
        self._centre: NDArray[Any] | None = None
        self._scale = np.ones(len(matrix.rows), np.float32)
        self._raw = np.empty((0, 0, 0))
        self._maps = np.empty((0, 0, 0), np.float32)

    def maps(self, integrals: Integrals, step: int = 1) -> Features:
        """(m, rows, columns) float32, the standardised features at every ``step`` px.

        The first call fixes, for each feature, the mean and the deviation that this and all
        further maps are centred and scaled with.
        """
        width, height = self.matrix.size
        rows = (integrals[0].shape[0] - 1 - height) // step + 1
        columns = (integrals[0].shape[1] - 1 - width) // step + 1
        shape = (len(self.matrix.rows), rows, columns)
        if self._maps.shape != shape or self._raw.dtype != integrals[0].dtype:
            self._raw = np.empty(shape, integrals[0].dtype)
            self._maps = np.empty(shape, np.float32)
        raw_feature_maps(integrals, self.matrix, self._raw, step)
        if self._centre is None:
            self._centre = self._fit(self._raw)
        # Centred before the conversion, where whole numbers are still exact.
        self._raw -= self._centre
        np.multiply(
            self._raw,
            self._scale[:, None, None],
            out=self._maps,
            casting="unsafe",
            dtype=np.float32,
        )
        return self._maps

    def _fit(self, raw: NDArray[Any]) -> NDArray[Any]:
        """Take the scale from raw maps (m, rows, columns) and return the centre (m, 1, 1)."""
        flat = raw.reshape(len(raw), -1)
        deviation = flat.std(axis=1)
        # A feature that is flat in the first frame is left in grey values per pixel.
        area = self.matrix.size[0] * self.matrix.size[1]
        self._scale = (1 / np.where(deviation > 0, deviation, area)).astype(np.float32)
        centre = np.rint(flat.mean(axis=1)).astype(raw.dtype)
        return np.asarray(centre[:, None, None])
