# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a hidden target is looked for: one search window a frame, farther and farther out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Places around the one where a target was last seen, in search radii.
_NEAR = ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1))
_FAR = ((2, 0), (-2, 0), (2, 1), (-2, -1), (2, -1), (-2, 1), (3, 0), (-3, 0))
_SPIRAL = np.array(_NEAR + _FAR, float)


def search_centre(hidden: int, predicted: Floats, seen_at: Floats, reach: Floats) -> Floats:
    """Where the target is looked for in this frame, image px (2,).

    A hidden target is looked for at its prediction in every other frame, and in between around
    the place where it was last seen, farther and farther from it.

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
