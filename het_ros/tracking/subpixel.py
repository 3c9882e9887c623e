# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Between the samples of a response."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def parabola_offset(values: NDArray[np.floating[Any]], peak: int) -> float:
    """Offset, -0.5..0.5, of the top of a parabola through a peak and its two neighbours.

    Args:
        values: (n,) samples.
        peak: index of the highest. At either end there is no parabola and the offset is 0.
    """
    if not 0 < peak < len(values) - 1:
        return 0.0
    left, top, right = values[peak - 1 : peak + 2].tolist()
    bend = left - 2 * top + right
    return float(min(max(0.5 * (left - right) / bend, -0.5), 0.5)) if bend < 0 else 0.0
