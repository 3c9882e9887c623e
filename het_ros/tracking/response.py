# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Middle layer, dense: every base ensemble votes for every place of the target.

Instead of one hypothesis a sub-patch (``combination``), the whole score map of each sub-patch is
moved back by its offset dp and all are averaged, so that a place which most sub-patches find
likely wins over one that a few find best. The vote of the colours is added to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.subpixel import parabola_offset

Floats = NDArray[np.float64]
Plane = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Peak:
    """The best place of a target in a response map.

    Attributes:
        corner: (x, y) of the target's corner there, px of the map, to a fraction of a px.
        template: mean score of the base ensembles there, about 1 for the target as learnt.
        colour: the colours' likelihood there, 0..1.
        rival: highest mean score of the base ensembles well away from there.
        patch_scores: (Q,) score of each sub-patch there.
    """

    corner: Floats
    template: float
    colour: float
    rival: float
    patch_scores: Floats


def vote(scores: Plane, offsets: NDArray[np.intp], shape: tuple[int, int]) -> Plane:
    """Mean of the base ensembles' scores for each place of the target.

    Args:
        scores: (Q, rows, columns), score of sub-patch q with its corner at each place.
        offsets: dp (Q, 2), x and y of the sub-patches in the target, px.
        shape: (rows, columns) of the places of the target's corner.
    """
    total = np.zeros(shape, scores.dtype)
    for one, (x, y) in zip(scores, offsets, strict=True):
        total += one[y : y + shape[0], x : x + shape[1]]
    total /= len(scores)
    return total


def find_peak(
    scores: Plane,
    offsets: NDArray[np.intp],
    colour: Plane,
    colour_weight: float,
    apart: tuple[int, int],
    prior: Plane | float = 1.0,
) -> Peak:
    """The place of the target that base ensembles and colours together find most likely.

    Args:
        scores: (Q, rows, columns) of the base ensembles.
        offsets: dp (Q, 2), px.
        colour: (rows', columns') likelihood for each place of the target's corner.
        colour_weight: share of the colours in the vote, 0..1.
        apart: (x, y), px: nearer than this a place is the same as the peak, not its rival.
        prior: (rows', columns') or one number that a place's vote is multiplied by.
    """
    template = vote(scores, offsets, (colour.shape[0], colour.shape[1]))
    response = ((1 - colour_weight) * template + colour_weight * colour) * prior
    row, column = divmod(int(response.argmax()), response.shape[1])
    corner = np.array(
        [
            column + parabola_offset(response[row], column),
            row + parabola_offset(response[:, column], row),
        ]
    )
    here = float(template[row, column])
    seen = float(colour[row, column])
    patches = scores[np.arange(len(scores)), row + offsets[:, 1], column + offsets[:, 0]]
    top, left = max(0, row - apart[1]), max(0, column - apart[0])
    template[top : row + apart[1] + 1, left : column + apart[0] + 1] = -1
    return Peak(corner, here, seen, float(template.max()), patches.astype(np.float64))
