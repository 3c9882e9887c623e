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
        cosines: (n, n) float32, -1..1, rows first.
        centre: (x, y), px of the image: the middle place.
        step: px of the image between two places.
    """

    cosines: Floats
    centre: tuple[float, float]
    step: float

    def at(self, place: tuple[float, float]) -> float:
        """That of the nearest place to (x, y), px of the image."""
        last = len(self.cosines) - 1
        column, row = (
            min(max(round((to - middle) / self.step + last / 2), 0), last)
            for to, middle in zip(place, self.centre, strict=True)
        )
        return float(self.cosines[row, column])


def cosines(template: Floats, search: Floats) -> Floats:
    """Cosine of the middle of a template with each place of a search crop.

    The middle is half of the template's side: its crop has the target with as much around it.

    Args:
        template: (C, t, t) features of the target's crop.
        search: (C, s, s) features of the search crop, s over t / 2.

    Returns:
        (n, n), n = s - t / 2 + 1; the middle place is that of the crop's middle.
    """
    side = template.shape[1] // 2
    first = (template.shape[1] - side) // 2
    middle = template[:, first : first + side, first : first + side]
    places = np.lib.stride_tricks.sliding_window_view(search, (side, side), axis=(1, 2))
    products = np.tensordot(middle, places, axes=((0, 1, 2), (0, 3, 4)))
    squares = np.lib.stride_tricks.sliding_window_view(
        np.square(search).sum(axis=0), (side, side)
    ).sum(axis=(2, 3))
    lengths = np.sqrt(squares * np.square(middle).sum())
    return np.asarray(products / np.maximum(lengths, 1e-9), np.float32)
