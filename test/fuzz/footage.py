# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A target that every tracker should follow."""

from functools import cache

import numpy as np
from moving_target import FIRST_BOX, moving_target

from het_ros import Box

BOX = Box(*FIRST_BOX)  # in the first frame; it moves by 2 px to the right a frame


@cache
def frames() -> list[np.ndarray]:
    """10 frames of 160 x 120 px."""
    return moving_target(10)
