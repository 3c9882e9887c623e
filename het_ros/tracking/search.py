# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a hidden target is looked for: farther and farther out, and later at other sizes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Places around the one where a target was last seen, in search radii.
_NEAR = ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1))
_FAR = ((2, 0), (-2, 0), (2, 1), (-2, -1), (2, -1), (-2, 1), (3, 0), (-3, 0))
_SPIRAL = np.array(_NEAR + _FAR, float)
_BY_COLOUR = 2  # of three frames away from the prediction
_SIZES = (0.84, 1.19, 0.71, 1.41)  # over the size when last seen
_OTHER_SIZES_AFTER = 0.7  # s


def by_colour(hidden: int) -> bool:
    """Whether the colours say where the target is looked for in this frame.

    Args:
        hidden: frames since it was last seen; 0 for a target in sight.
    """
    return hidden % 2 == 1 and hidden // 2 % (_BY_COLOUR + 1) != 0


def search_centre(hidden: int, predicted: Floats, seen_at: Floats, reach: Floats) -> Floats:
    """Where the target is looked for in a frame in which the colours do not say it, image px (2,).

    A hidden target is looked for at its prediction in every other frame, and in between where the
    colours send it (:func:`by_colour`) or around the place where it was last seen, farther and
    farther from it.

    Args:
        hidden: frames since it was last seen; 0 for a target in sight.
        predicted: (x, y) by the motion model, px.
        seen_at: (x, y) where it was last seen, px.
        reach: (x, y), how far one search window reaches, px.
    """
    if hidden % 2 == 0:
        return predicted
    step = (hidden // 2) % min(1 + hidden // 2, len(_SPIRAL))
    return np.asarray(seen_at + _SPIRAL[step] * reach)


def other_size(hidden: int, hidden_for: float) -> float | None:
    """At what part of its size the target is looked for a second time in this frame, or None.

    Who stays away comes back nearer or farther, and the features know one size only. The second
    look costs as much as the first, so it is for those who were gone for long.

    Args:
        hidden: frames since the target was last seen.
        hidden_for: s since then.
    """
    if hidden_for < _OTHER_SIZES_AFTER:
        return None
    return _SIZES[(hidden // 2) % len(_SIZES)]
