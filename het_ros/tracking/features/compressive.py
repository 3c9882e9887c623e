# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Compressive features of sub-patches, as dense maps over the search window.

All sub-patches have one size and share one measurement matrix. So a compressive feature is one map
over the window, its value at (x, y) being that of a sub-patch whose corner is there, and every
sub-patch reads the same maps.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.buffers import Buffers

Integrals = Sequence[NDArray[Any]]
FeatureMaps = NDArray[np.floating[Any]]
_Operation = tuple[Callable[..., Any], FeatureMaps, FeatureMaps, FeatureMaps]


@dataclass(frozen=True)
class SumsConfig:
    """Constants of the sums.

    Attributes:
        exact_in_float32: whole numbers below this are (geometry: float32's mantissa).
        cache: so many sums stay in a processor's cache (chosen: 1 MB of float32).
    """

    exact_in_float32: int = 2**24
    cache: int = 2**18


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
    """The sparse random matrix R, eq. (3) "random metrix", fixed at the first frame.

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


def raw_feature_maps(integrals: Integrals, matrix: MeasurementMatrix) -> FeatureMaps:
    """L = R H, eq. (2) "1", for the sub-patches at all places of a window.

    Args:
        integrals: C integral images (H + 1, W + 1) of one dtype.
        matrix: R, with sub-patches of (w, h).

    Returns:
        (m, H - h + 1, W - w + 1) float64: the features of the sub-patches with their corners at
        column x and row y.
    """
    count = len(matrix.rows)
    sums = RectangleSums(matrix, integrals, np.zeros(count), np.ones(count))
    return sums(integrals)


class RectangleSums:
    """The features of one window after another, all of one size.

    Which numbers are added to which is worked out once: a frame is a list of additions and
    subtractions between parts of scratch buffers, which never leave. All planes are read as flat
    arrays: parts of those are contiguous, and several times faster than parts of rows and
    columns. What comes of the places from column W - w + 1 on runs over the border and is cut
    off.

    Args:
        matrix: R, with sub-patches of (w, h).
        integrals: C integral images (H + 1, W + 1), of which the shape and the dtype count. Sums
            of whole numbers are exact: in float32 where all of them fit, else in float64.
        centre: (m,), whole numbers; what is subtracted from a feature.
        scale: (m,), what it is multiplied with then; the maps are of its dtype.
    """

    def __init__(
        self,
        matrix: MeasurementMatrix,
        integrals: Integrals,
        centre: FeatureMaps,
        scale: FeatureMaps,
    ) -> None:
        self.shape = integrals[0].shape
        lines, stride = self.shape
        width, height = matrix.size
        whole = np.issubdtype(integrals[0].dtype, np.integer)
        exact = whole and 255 * lines * stride < SumsConfig().exact_in_float32
        self._stack = np.zeros((len(integrals), *self.shape), np.float32 if exact else np.float64)
        self._bank = np.empty(0, self._stack.dtype)
        # What comes of places up to here is asked for.
        self._places = (lines - height) * stride - width
        sums = np.zeros((lines - height, stride), self._stack.dtype)
        self._total, self._wanted = sums.reshape(-1)[: self._places], sums[:, : stride - width]
        self._band_scratch = np.empty(self._places + width, sums.dtype)
        self._scale = scale
        self._buffers = Buffers()
        # An array of one number, not a number: NumPy 1 would subtract in the sums' dtype.
        centres = centre.astype(sums.dtype)[:, None]
        self._program = self._compile(matrix.rows, centres)

    def __call__(self, integrals: Integrals) -> FeatureMaps:
        """The features of a window, (m, H - h + 1, W - w + 1).

        No later call writes them while somebody holds them or a view of them.

        Args:
            integrals: C integral images of the shape and dtype said at first.
        """
        for plane, integral in zip(self._stack, integrals, strict=True):
            plane[...] = integral
        maps = self._buffers.empty((len(self._scale), *self._wanted.shape), self._scale.dtype)
        planes, sums = list(maps), self._wanted
        same = sums.dtype == maps.dtype
        for feature, scale, operations in self._program:
            for operation, one, other, out in operations:
                operation(one, other, out)
            plane = planes[feature]
            if same:
                np.multiply(sums, scale, plane)
            else:  # copied first: faster than multiplying into another dtype
                plane[...] = sums
                np.multiply(plane, scale, plane)
        return maps

    def _compile(
        self, rows: Sequence[Sequence[Rectangle]], centres: FeatureMaps
    ) -> list[tuple[int, FeatureMaps, list[_Operation]]]:
        """What makes each feature's centred sums in ``_total``, channel after channel."""
        program: list[tuple[int, FeatureMaps, list[_Operation]]] = []
        channel, bands = -1, {}
        for feature in sorted(range(len(rows)), key=lambda feature: rows[feature][0].channel):
            operations: list[_Operation] = []
            row = rows[feature]
            if row[0].channel != channel:
                channel = row[0].channel
                in_channel = [r for row in rows for r in row if r.channel == channel]
                bands = self._bands(in_channel, operations)
            for k, rectangle in enumerate(row):
                # First the sums over all rows of the rectangle, then between two columns of them.
                band = self._band(rectangle, bands, operations)
                left, right = band[: self._places], band[rectangle.x1 - rectangle.x0 :]
                plus, minus = (right, left) if rectangle.sign > 0 else (left, right)
                if k:
                    operations.append((np.add, self._total, plus, self._total))
                    plus = self._total
                operations.append((np.subtract, plus, minus, self._total))
            # Centred first, where whole numbers are still exact.
            operations.append((np.subtract, self._total, centres[feature], self._total))
            program.append((feature, self._scale[feature : feature + 1, None], operations))
        return program

    def _bands(
        self, rectangles: Sequence[Rectangle], operations: list[_Operation]
    ) -> dict[int, FeatureMaps]:
        """Sums over so many rows of each column of a channel, flat, by number of rows.

        Those that several ``rectangles`` of the channel share, or none where they are too many.
        """
        uses = Counter(rectangle.y1 - rectangle.y0 for rectangle in rectangles)
        heights = [height for height, times in uses.items() if times > 1]
        flat, stride = self._stack[rectangles[0].channel].reshape(-1), self.shape[1]
        if len(heights) * flat.size > SumsConfig().cache:
            return {}
        # All channels in turn have theirs in the same place.
        if self._bank.size < len(heights) * flat.size:
            self._bank = np.zeros(len(heights) * flat.size, flat.dtype)
        bands = self._bank[: len(heights) * flat.size].reshape(len(heights), flat.size)
        for height, band in zip(heights, bands, strict=True):
            size = flat.size - height * stride
            operations.append((np.subtract, flat[height * stride :], flat[:size], band[:size]))
        return dict(zip(heights, bands, strict=True))

    def _band(
        self, rectangle: Rectangle, bands: dict[int, FeatureMaps], operations: list[_Operation]
    ) -> FeatureMaps:
        """Sums over the rectangle's rows at each place and its width beyond the last of them."""
        channel, x0, y0, x1, y1, _ = rectangle
        upper, span = y0 * self.shape[1] + x0, self._places + x1 - x0
        if y1 - y0 in bands:
            return bands[y1 - y0][upper : upper + span]
        flat, lower = self._stack[channel].reshape(-1), upper + (y1 - y0) * self.shape[1]
        parts = flat[lower : lower + span], flat[upper : upper + span]
        operations.append((np.subtract, *parts, self._band_scratch[:span]))
        return self._band_scratch[:span]


class CompressiveFeatures:
    """Feature maps, centred and scaled by what the first frame's features were like.

    Without that the squares of sums over thousands of pixels would cancel each other's digits.

    Args:
        matrix: R.
        dtype: of the maps. In float32 scores are good to some 1e-5 of the largest.
    """

    def __init__(self, matrix: MeasurementMatrix, dtype: type[np.floating[Any]] = np.float64):
        self.matrix = matrix
        self._dtype = dtype
        self._normalisation: tuple[FeatureMaps, FeatureMaps] | None = None
        self._sums: RectangleSums | None = None

    def __getstate__(self) -> dict[str, Any]:
        """A copy makes sums of its own: they write through views, which copying would part."""
        return {**self.__dict__, "_sums": None}

    def maps(self, integrals: Integrals) -> FeatureMaps:
        """(m, rows, columns) of the normalised features at every place of a window.

        The first call fixes, for each feature, the mean and the deviation that this and all
        further maps are centred and scaled with. No later call writes maps that somebody holds.

        Args:
            integrals: C integral images (H + 1, W + 1) of one dtype.
        """
        if self._sums is None or self._sums.shape != integrals[0].shape:
            if self._normalisation is None:
                self._normalisation = self._fit(raw_feature_maps(integrals, self.matrix))
            self._sums = RectangleSums(self.matrix, integrals, *self._normalisation)
        return self._sums(integrals)

    @property
    def normalisation(self) -> tuple[FeatureMaps, FeatureMaps]:
        """(m,) what is subtracted from each raw feature and (m,) what it is multiplied with then.

        Raises:
            RuntimeError: no window was seen.
        """
        if self._normalisation is None:
            raise RuntimeError("features are normalised by the first window: call maps first")
        return self._normalisation

    def _fit(self, raw: FeatureMaps) -> tuple[FeatureMaps, FeatureMaps]:
        """Centre (m,) and scale (m,) of raw maps (m, rows, columns)."""
        deviation = raw.std(axis=(1, 2))
        # A feature that is flat in the first frame is left in gray values per pixel.
        area = self.matrix.size[0] * self.matrix.size[1]
        scale = 1 / np.where(deviation > 0, deviation, area)
        return np.rint(raw.mean(axis=(1, 2))), scale.astype(self._dtype)
