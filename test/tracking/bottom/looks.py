# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Looks at images made for tests: working px or cells as wanted, at any place and scale."""

import numpy as np

from het_ros.tracking.bottom.ensemble import Look
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.features.window import cut_window

FEW = np.zeros((1, 1, 1), np.float32)


def look_at(
    image, corner, shape, scale=1.0, *, cell=1, features=FEW, expected=(0.0, 0.0), **given
):
    """A look at the window of ``shape`` (w, h) px with its corner at (x, y) of an image.

    Args:
        given: fields of the look instead of those of a target of 20 x 30 cells.
    """
    window = cut_window(image, *corner, *shape, (scale, scale))
    window = type(window)(window.pixels.copy(), window.origin, window.scale)
    frame = Frame.of(window.in_cells(cell), (), features)
    fields = {
        "size": np.array([20.0, 30.0]) * cell / scale,
        "cells": (20, 30),
        "places": (shape[1] // cell - 29, shape[0] // cell - 19),
        "confidence": 1.0,
    }
    return Look(frame, image, np.array(expected), **{**fields, **given})
