# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether a box holds the target by its depth, and how far away the target is.

The depth of a body changes little from frame to frame. So the target is the surface nearest to its
last depth, and it is not in a box that this surface fills much less of than it used to: there is
a column before it, or the box is on the wall behind it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.ros.depth import LEAST_SHARE, DepthError, nearest_surface, samples_in, surfaces
from het_ros.ros.stamps import SECOND
from het_ros.tracking.box import Box

SLACK = 0.5  # m: so much the depths of a body differ, and change from frame to frame
FASTEST = 4.0  # m/s between camera and target, while nothing is looked at
HIDDEN = 0.8  # m/s, while something else is seen in the target's place
BLINK = 0.5  # s: over a longer time without a look, anything within FASTEST may have happened
LEAST_PART = 0.5  # of the usual share of the box, or the box holds something else
COVERS = 0.3  # share of the box from which on what is nearer counts as an obstacle
BEHIND = 0.3  # m: so far behind an obstacle whom it hides is at least
SHARE_RATE = 0.05  # of the running mean of the share, a frame


class TargetDepth:
    """The depth of a track's target; another track is another target.

    All stamps are ns, boxes are in an image of ``size`` (width, height) px, and ``metres`` is of
    the same view, ``(H, W) float32``, NaN where invalid.
    """

    def __init__(self) -> None:
        self._track = -1
        self._depth = 0.0
        self._share = 1.0
        self._stamp = 0
        self._looked = 0
        self._obstacle = 0.0

    def may_be_in(
        self,
        box: Box,
        size: tuple[int, int],
        metres: NDArray[np.float32],
        stamp: int,
        track: int,
    ) -> bool:
        """Whether the target may be in a box; True as well where the depth says nothing of it."""
        if track != self._track:
            return True
        try:
            samples = samples_in(box, size, metres)
        except DepthError:
            return True
        _, share = self._surface(samples, stamp)
        if share >= LEAST_PART * self._share:
            return True
        nearer = samples[samples < self._depth - SLACK]
        if nearer.size > COVERS * samples.size:
            self._obstacle = float(np.median(nearer))
        return False

    def measure(
        self,
        box: Box,
        size: tuple[int, int],
        metres: NDArray[np.float32],
        stamp: int,
        track: int,
    ) -> float:
        """The depth of the target in a box that is taken to hold it, m along the optical axis.

        Raises:
            DepthError: it is not there by its depth, or there is too little depth.
        """
        samples = samples_in(box, size, metres)
        if track != self._track:
            self._track, self._obstacle = track, 0.0
            self._depth, self._stamp = nearest_surface(samples), stamp
            _, self._share = self._surface(samples, stamp)
            return self._depth
        depth, share = self._surface(samples, stamp)
        if share < LEAST_PART * self._share:
            raise DepthError(
                f"the depth went from {self._depth:.1f} to {np.median(samples):.1f} m in "
                f"{(stamp - self._stamp) / SECOND:.2f} s: that is another thing in the box"
            )
        self._depth, self._stamp, self._obstacle = depth, stamp, 0.0
        self._share += SHARE_RATE * (share - self._share)
        return depth

    def _surface(self, samples: NDArray[np.float32], stamp: int) -> tuple[float, float]:
        """Depth and share of the samples (n,) of the surface that is the target's, if any is."""
        passed = max(stamp - self._stamp, 0) / SECOND
        watched = (stamp - self._looked) / SECOND < BLINK
        self._looked = stamp
        allowed = SLACK + passed * (HIDDEN if watched else FASTEST)
        behind = self._obstacle + BEHIND if self._obstacle else 0.0
        found, least = (0.0, 0.0), allowed
        for surface in surfaces(samples):
            depth, share = float(np.median(surface)), surface.size / samples.size
            off = abs(depth - self._depth)
            if depth >= behind and share >= LEAST_SHARE and off <= least:
                found, least = (depth, share), off
        return found
