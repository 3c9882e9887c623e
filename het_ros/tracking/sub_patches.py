# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The random overlapping sub-patches of a target, and which of them are to be updated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Patch
from het_ros.tracking.window import Window

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SubPatches:
    """Layout of the sub-patches in the target, fixed at the first frame (eq. patches).

    Of a sub-patch <g, c, dp, p> these are the size and dp. Its place p, its score c and its
    features g change with every frame: p follows from :meth:`corners`, c and g from the bottom
    layer.

    Attributes:
        size: (w, h) of every sub-patch, working px.
        offsets: dp, (Q, 2) float64: corner of a sub-patch relative to the target's, working px.
    """

    size: tuple[int, int]
    offsets: NDArray[np.float64]

    def corners(self, target: NDArray[np.float64]) -> NDArray[np.float64]:
        """Places p (Q, 2) of the sub-patches of a target whose corner is at (2,), working px.

        At the end of a frame this is the re-extraction of the model update: the sub-patches are
        put back into the layout of the first frame.
        """
        return target + self.offsets

    def in_image(self, window: Window, corners: Floats, weights: Floats) -> tuple[Patch, ...]:
        """The sub-patches where they were found, as upright boxes in image px.

        Args:
            window: that they were found in, its places in working px.
            corners: (Q, 2), working px.
            weights: (Q,), in the combination.
        """
        size = np.array(self.size)
        width, height = (size / np.array(window.scale)).tolist()
        box = Box.from_centre(0, 0, width, height).turned(window.angle)
        centres = window.to_image(corners + size / 2).tolist()
        return tuple(
            Patch(Box.from_centre(x, y, box.w, box.h), weight)
            for (x, y), weight in zip(centres, weights.tolist(), strict=True)
        )


def draw_sub_patches(
    target: tuple[float, float], count: int, fraction: float, rng: np.random.Generator
) -> SubPatches:
    """Lay out ``count`` sub-patches at random inside a target.

    Args:
        target: (w, h) of the target, working px.
        count: Q.
        fraction: side of a sub-patch over the target's.
        rng: where the offsets are drawn from, uniformly among those inside the target.
    """
    width, height = (max(1, round(fraction * side)) for side in target)
    room = [max(0, int(target[0] - width)), max(0, int(target[1] - height))]
    offsets = rng.integers(0, room, size=(count, 2), endpoint=True).astype(np.float64)
    return SubPatches((width, height), offsets)


def to_be_updated(scores: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which sub-patches to update: scores within mu_c +- sigma_c (eq. patchUpdate).

    Those far above are left alone as well as those far below. Where all scores are the same the
    open interval is empty and none stands out: then all are updated.

    Args:
        scores: c_new (Q,), raw scores of the re-extracted sub-patches.

    Returns:
        (Q,) bool.
    """
    spread = scores.std()
    if spread == 0:
        return np.ones(scores.shape, bool)
    return np.asarray(np.abs(scores - scores.mean()) < spread)
