# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A target that every tracker should follow."""

from functools import cache

import cv2
import numpy as np

from het_ros import Box

BOX = Box(20, 40, 20, 32)  # in the first frame; it moves by 2 px to the right a frame


@cache
def frames() -> list[np.ndarray]:
    """10 frames of 160 x 120 px."""
    rng = np.random.default_rng(5)
    ground = cv2.GaussianBlur(rng.integers(0, 160, (120, 160, 3), np.uint8), (0, 0), 3)
    target = cv2.resize(rng.integers(0, 255, (8, 5, 3), np.uint8), (20, 32))
    made = []
    for i in range(10):
        frame = ground.copy()
        x, y = 20 + 2 * i, 40 + i // 2
        frame[y : y + 32, x : x + 20] = target
        made.append(frame)
    return made
