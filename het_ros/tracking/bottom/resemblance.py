# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How much a place is like the first box, by the features of a siamese network.

The network's own score tells a thing from what is around it, and is near 1 on the column that
hides a person. Its features tell the column from the person, and those of the first box do not
change with what is learnt. They are there already: a place costs no further pass of the network.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Resemblance:
    """Of the places in a search crop to the first box.

    Attributes:
        target: (C, k, k) float32 features of the first box; see :func:`middle_of`.
        search: (C, s, s) float32 features of the search crop, s at least k.
        centre: (x, y), px of the image: the crop's middle.
        step: px of the image between two places.
    """

    target: Floats
    search: Floats
    centre: tuple[float, float]
    step: float

    def at(self, place: tuple[float, float]) -> float:
        """The cosine, -1..1, of the target with the nearest place to (x, y), px of the image."""
        side = self.target.shape[1]
        last = self.search.shape[1] - side
        column, row = (
            min(max(round((to - middle) / self.step + last / 2), 0), last)
            for to, middle in zip(place, self.centre, strict=True)
        )
        there = self.search[:, row : row + side, column : column + side]
        lengths = np.linalg.norm(self.target) * np.linalg.norm(there)
        return float((self.target * there).sum() / max(lengths, 1e-9))


def middle_of(template: Floats) -> Floats:
    """(C, t / 2, t / 2): the target in the features (C, t, t) of its crop.

    It is half of the crop's side: the crop has as much around the target.
    """
    side = template.shape[1] // 2
    first = (template.shape[1] - side) // 2
    return template[:, first : first + side, first : first + side]
