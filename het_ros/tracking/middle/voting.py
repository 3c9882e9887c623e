# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The votes of all base ensembles together: where the target is most likely."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Plane = NDArray[np.float32]


@dataclass(frozen=True)
class VotingConfig:
    """Constants of the vote.

    Attributes:
        apart: target sides from the best place beyond which another one is a distractor, a
            secondary peak (chosen: boxes so far apart overlap by less than half).
        least_apart: the same in cells (geometry: a peak is that wide).
        near: cells around a given place in which its votes are read (geometry: likewise).
    """

    apart: float = 0.35
    least_apart: int = 2
    near: int = 2


@dataclass(frozen=True)
class Peak:
    """The best place of a target.

    Attributes:
        corner: (x, y) of the target's corner there, cells, to a fraction of a cell.
        row, column: the same, whole.
    """

    corner: Floats
    row: int
    column: int


def best_place(response: Plane) -> Peak:
    """The peak of a response map (rows, columns), sub-cell by a parabola in each direction."""
    row, column = divmod(int(response.argmax()), response.shape[1])
    x = column + parabola_offset(response[row], column)
    y = row + parabola_offset(response[:, column], row)
    return Peak(np.array([x, y]), row, column)


def peak_near(response: Plane, corner: Floats) -> Peak:
    """The highest of the places next to a corner (x, y), cells; the corner itself is kept."""
    reach = VotingConfig().near
    rows, columns = response.shape
    column = min(max(round(float(corner[0])), 0), columns - 1)
    row = min(max(round(float(corner[1])), 0), rows - 1)
    top, left = max(0, row - reach), max(0, column - reach)
    around = response[top : row + reach + 1, left : column + reach + 1]
    down, right = divmod(int(around.argmax()), around.shape[1])
    return Peak(corner, top + down, left + right)


def distractor(template: Plane, peak: Peak, cells: tuple[int, int]) -> float:
    """Highest score well away from a peak, or -1 where there is no such place.

    Args:
        template: (rows, columns) mean score of the sub-patches.
        peak: the best place.
        cells: (w, h) of the target.
    """
    config = VotingConfig()
    apart_x, apart_y = (max(config.least_apart, round(config.apart * side)) for side in cells)
    elsewhere = template.copy()
    top, left = max(0, peak.row - apart_y), max(0, peak.column - apart_x)
    elsewhere[top : peak.row + apart_y + 1, left : peak.column + apart_x + 1] = -1
    return float(elsewhere.max())


def parabola_offset(values: NDArray[np.floating], index: int) -> float:
    """How far, within half a step, the top of a parabola lies from the largest of its points.

    Args:
        values: (n,).
        index: of the largest; 0 is returned at either end and where the three points are level.
    """
    if not 0 < index < len(values) - 1:
        return 0.0
    left, middle, right = (float(v) for v in values[index - 1 : index + 2])
    bend = left - 2 * middle + right
    return 0.0 if bend >= 0 else min(max(0.5 * (left - right) / bend, -0.5), 0.5)
