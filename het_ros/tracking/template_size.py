# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A third opinion on the target's size: what its own base ensembles say of other sizes.

Filters that follow a change of size from frame to frame add up their errors. The base ensembles
learn more slowly and see all of the target; whether they score higher where it is looked at a
little larger or a little smaller tells whether the size is right by now. All votes of linear base
ensembles together are one template of weights for the cells of the target's channels, so that a
size costs no more than to read the target at it.
"""

from __future__ import annotations

import math

import numpy as np

from het_ros.tracking.grid_means import Floats, Planes, grid_means
from het_ros.tracking.template import Template

_STEP = 0.08  # part of the size that is added and taken away
_LEAST_SCORE = 0.2  # the slope is taken over the score, or this
# Slope of the score over the logarithm of the size where that is right: templates prefer smaller
# ones. Half is the mean of many targets, half that of the target's own first looks.
_USUAL = -0.25
_LOOKS = 15
_UNKNOWN = 8  # looks after which the mean is known well enough to go by
_MOST = 0.5  # of the slope that is believed
_GAIN = 0.01  # logarithm of the size a look, over the slope
_EVERY = 2  # frames: sizes change slowly, and a template costs as much as a scale filter


class TemplateSize:
    """Draws the size slowly to where the base ensembles score as they did at first."""

    def __init__(self) -> None:
        self._frames = 0
        self._looks = 0
        self._mean = 0.0

    def is_due(self) -> bool:
        """Whether a frame is one to look at; called once a frame."""
        self._frames += 1
        return self._frames % _EVERY == 0

    def change(self, planes: Planes, centre: Floats, template: Template) -> float:
        """Ratio by which the size is to be drawn.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.
            template: the base ensembles' weights.
        """
        slope = size_slope(planes, centre, template)
        self._looks += 1
        if self._looks <= _LOOKS:
            self._mean += (slope - self._mean) / self._looks
        if self._looks <= _UNKNOWN:
            return 1.0
        off = slope - (_USUAL + self._mean) / 2
        return math.exp(_GAIN * min(max(off, -_MOST), _MOST))


def size_slope(planes: Planes, centre: Floats, template: Template) -> float:
    """How the template's score grows with the logarithm of the size, over the score.

    Args:
        planes: C channels (H, W) uint8.
        centre: (x, y) of the target, px of the channels.
        template: of a target as large as the channels show it.
    """
    rows, _, columns = template.weights.shape
    sizes = np.array([1 - _STEP, 1.0, 1 + _STEP])
    sides = sizes[:, None] * (columns, rows)
    means = grid_means(planes, centre, sides, (columns, rows))
    smaller, here, larger = means.reshape(3, -1) @ template.weights.ravel() + template.constant
    return float((larger - smaller) / (2 * _STEP) / max(abs(here), _LEAST_SCORE))
