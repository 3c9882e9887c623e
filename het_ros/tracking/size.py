# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The target's size: that of its first box, and how much it has grown since."""

from __future__ import annotations

import math

import numpy as np

from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.grid_means import Floats, Planes
from het_ros.tracking.layers import Cells, scale_filter, size_regression
from het_ros.tracking.template import Template
from het_ros.tracking.template_size import TemplateSize

_SIZES_KNOWN = 15  # frames after which the scale filter has seen enough to be followed
_SMALLEST_SIDE = 3.0  # px: below this a target is not shrunk any more


class Size:
    """Follows the target's size by up to four opinions, as far as they are believed.

    The scale filter and the regression say what has changed and count half each; the template
    and the first frame draw slowly to where the size was right at first.

    Args:
        config: parameters.
        box: the target's first one.
        cells: (w, h) of the target in cells.

    Attributes:
        first: (w, h) of the first box, px.
        growth: the size over that of the first box.
    """

    def __init__(self, config: TrackerConfig, box: Box, cells: Cells) -> None:
        self.first: Floats = np.array([box.w, box.h])
        self.growth = 1.0
        self._filter = scale_filter(config, cells) if config.scales > 1 else None
        regressed = self._filter and config.size_regression
        self._regression = size_regression(config, cells) if regressed else None
        drawn = self._filter and config.size_template
        self._template_size = TemplateSize() if drawn else None
        self._limit = config.growth_limit
        self._frames = 0

    def box(self, centre: Floats, growth: float | None = None) -> Box:
        """The target's box at ``centre`` (x, y), px, at the present growth or at another."""
        width, height = self.first * (self.growth if growth is None else growth)
        return Box.from_centre(float(centre[0]), float(centre[1]), float(width), float(height))

    def side(self, growth: float) -> float:
        """sqrt(w h), px, of the target's box at that growth."""
        return growth * math.sqrt(self.first.prod())

    def asks_template(self) -> bool:
        """Whether the base ensembles' template counts in this frame; called once a frame."""
        return self._template_size is not None and self._template_size.is_due()

    def follow(
        self,
        planes: Planes,
        centre: Floats,
        dt: float,
        template: Template | None = None,
        drawn: float = 1.0,
    ) -> float:
        """Take over the change of size in a frame; returns the ratio to the size before.

        Args:
            planes: C channels (H, W) uint8.
            centre: (x, y) of the target, px of the channels.
            dt: time since the last frame, s.
            template: of the base ensembles, where it is asked for and they have one.
            drawn: ratio by which the first frame draws the size.
        """
        if self._filter is None:
            return 1.0
        ratio = self._filter.change(planes, centre)
        if self._regression:
            ratio = math.sqrt(ratio * self._regression.change(planes, centre))
        ratio *= drawn
        if template and self._template_size:
            ratio *= self._template_size.change(planes, centre, template)
        self._frames = min(self._frames + 1, _SIZES_KNOWN)
        fastest = math.exp(self._limit * dt * self._frames / _SIZES_KNOWN)
        ratio = min(max(ratio, 1 / fastest), fastest)
        least = _SMALLEST_SIDE / float(self.first.min())
        before = self.growth
        self.growth = max(before * ratio, min(before, least))
        return self.growth / before

    def learn(self, planes: Planes, centre: Floats, ratio: float) -> None:
        """Learn what the target looks like, ``ratio`` times as large as it was looked for."""
        if self._filter:
            self._filter.learn(planes, centre, ratio)
        if self._regression:
            self._regression.learn(planes, centre, ratio)
