# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Made footage that every tracker should follow."""

import cv2
import numpy as np

FIRST_BOX = (20, 40, 20, 32)  # of the moving target, px


def moving_target(count: int) -> list[np.ndarray]:
    """BGR frames of 160 x 120 px: a textured target that moves 2 px a frame from FIRST_BOX on."""
    left, top, width, height = FIRST_BOX
    rng = np.random.default_rng(5)
    ground = cv2.GaussianBlur(rng.integers(0, 160, (120, 160, 3), np.uint8), (0, 0), 3)
    target = cv2.resize(rng.integers(0, 255, (8, 5, 3), np.uint8), (width, height))
    frames = []
    for i in range(count):
        frame = ground.copy()
        x, y = left + 2 * i, top + i // 2
        frame[y : y + height, x : x + width] = target
        frames.append(frame)
    return frames
