# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Windows and features in the most obvious way: loops over places and rectangles."""

import numpy as np


def replicated_window(image, left, top, width, height):
    """Rows of the window, each px looked up by itself with the border repeated."""
    rows = [min(max(y, 0), image.shape[0] - 1) for y in range(top, top + height)]
    columns = [min(max(x, 0), image.shape[1] - 1) for x in range(left, left + width)]
    return np.array([[image[y, x] for x in columns] for y in rows])


def feature(planes, row, x, y):
    """One compressive feature of the sub-patch with its corner at (x, y) (eq. 2)."""
    total = 0
    for channel, x0, y0, x1, y1, sign in row:
        total += sign * int(planes[channel][y + y0 : y + y1, x + x0 : x + x1].sum())
    return total


def all_features(planes, rows, size):
    """{(x, y): [l_1 ... l_m]} for every place of the window."""
    height, width = planes[0].shape
    return {
        (x, y): [feature(planes, row, x, y) for row in rows]
        for y in range(height - size[1] + 1)
        for x in range(width - size[0] + 1)
    }
