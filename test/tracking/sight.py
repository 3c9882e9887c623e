# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a tracker sees of a target in a real frame, at any size and place."""

import numpy as np

from het_ros.tracking.channels import channel_stack
from het_ros.tracking.window import cut_window

CHANNELS = ("lightness", "green_red", "blue_yellow", "gradient")


def seen(frames, zoom=1.0, side=48, beside=(0.0, 0.0), index=0):
    """(planes, centre, size): a frame's target ``zoom`` times as large, at 24 cells a side."""
    image, box = frames.image(index), frames.boxes[index]
    shape = side * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = zoom * side / np.sqrt(box.area)
    half = 1.3 * shape
    width, height = np.ceil(2 * half).astype(int)
    x, y = np.array(box.centre) - half / scale
    window = cut_window(image, x, y, int(width), int(height), (scale, scale))
    size = round(shape[0] / 2), round(shape[1] / 2)
    return channel_stack(window.pixels, CHANNELS, 2), half / 2 + np.array(beside) * size, size
