# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A base ensemble in one file: it votes for places as bright as the target."""

import cv2
import numpy as np

from het_ros import Box, HierarchicalEnsembleTracker
from het_ros.tracking.bottom.ensemble import Look, Plane


class BrightnessEnsemble:
    """Knows the target's mean gray level.

    Args:
        image: (H, W, 3) or (H, W) uint8, the first one.
        box: the target in it, px.
    """

    RATE = 0.05  # of what is learnt
    TOLERANCE = 20.0  # gray levels at which a vote has fallen to exp(-1)

    def __init__(self, image: np.ndarray, box: Box) -> None:
        self._level = float(self._mean_levels(image, (box.w, box.h), np.array(box.centre)))

    def vote(self, look: Look) -> Plane:
        """1 at places as bright as the target, towards 0 elsewhere; ``look.places`` float32."""
        rows, columns = look.places
        corners = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1)
        levels = self._mean_levels(look.image, look.size, look.centre_of(corners))
        return np.exp(-(((levels - self._level) / self.TOLERANCE) ** 2)).astype(np.float32)

    def learn(self, look: Look, box: Box, weight: float) -> None:
        """The target is in ``box``: follow its level with the given weight."""
        level = float(self._mean_levels(look.image, (box.w, box.h), np.array(box.centre)))
        self._level += weight * self.RATE * (level - self._level)

    def forget(self) -> None:
        """The target was not seen: the level stays."""

    @staticmethod
    def _mean_levels(image, size, centres) -> np.ndarray:
        """Mean gray level of boxes of one size around ``centres`` (..., 2), image px."""
        gray = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        means = cv2.blur(gray, tuple(max(1, round(float(side))) for side in size))
        x, y = np.moveaxis(centres.round().astype(int), -1, 0)
        height, width = gray.shape
        return means[y.clip(0, height - 1), x.clip(0, width - 1)].astype(np.float64)


def tracker() -> HierarchicalEnsembleTracker:
    """The default tracker with one more base ensemble."""
    return HierarchicalEnsembleTracker(further=[BrightnessEnsemble])
