# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the tracker says of one frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.motion import Motion

# Deviation of a box on its target that is sure, in its sides, and what doubt adds to it. Over the
# frames of many real tracks it was .06 at a score of .95, .10 at .75, .13 at .55 and .20 at .35.
_LASTING, _BY_DOUBT = 0.05, 0.2


class State(Enum):
    """Where the tracker stands."""

    IDLE = "IDLE"  # no target was given yet
    TRACKING = "TRACKING"  # the target was measured in this frame
    COASTING = "COASTING"  # not seen: the box is the motion model's prediction
    LOST = "LOST"  # not seen for too long: the box means nothing


@dataclass(frozen=True)
class Patch:
    """One sub-patch as it was found in a frame, for drawing.

    Attributes:
        box: where the base ensemble found the sub-patch, px.
        weight: its weight in the combination, 0..1.
    """

    box: Box
    weight: float


@dataclass(frozen=True)
class Estimate:
    """The tracker's answer to one frame.

    Attributes:
        box: filtered box, px; in LOST the last prediction, not to be acted on.
        velocity: (vx, vy) of the target's centre in the image, px/s: its own motion and what the
            camera's makes of it.
        covariance: (4, 4) float64 of the state [cx, cy, vx, vy], px^2, px^2/s, px^2/s^2; with what
            a box misses its target by for good, which is more the lower the score. Where two
            filters give place and velocity, no correlation of the two is given.
        score: 0..1, probability that the box is right (overlap over 0.5); 0 in LOST.
        state: TRACKING, COASTING or LOST.
        patches: the Q sub-patches of this frame; empty when nothing was measured.
        velocity_in_scene: (vx, vy), px/s, without the camera's motion: against what stands still;
            None where that is not known.
        motion: what :meth:`predict` goes by; None: a constant velocity.
    """

    box: Box
    velocity: tuple[float, float]
    covariance: NDArray[np.float64]
    score: float
    state: State
    patches: tuple[Patch, ...] = ()
    velocity_in_scene: tuple[float, float] | None = None
    motion: Motion | None = None

    def predict(self, dt: float) -> Estimate:
        """Where the target will be.

        Args:
            dt: time ahead, s, 0 or more; the camera is taken to go on as it does.

        Returns:
            Box, velocity and covariance of that moment; score, state and size are those of now.

        Raises:
            ValueError: ``dt`` is negative, NaN or infinite.
        """
        if not (math.isfinite(dt) and dt >= 0):
            raise ValueError(f"dt must be a number of seconds, 0 or more, not {dt}")
        if self.motion is None:
            move = np.eye(4) + dt * np.eye(4, k=2)
            way = dt * np.array(self.velocity)
            velocity, covariance = self.velocity, move @ self.covariance @ move.T
        else:
            later, way = self.motion.later(dt), self.motion.way(dt)
            velocity, covariance = later.total, self.covariance.copy()
            covariance[:2, :2] += self.motion.way_covariance(dt)
            covariance[2:, 2:] = later.covariance
        x, y = (np.array([self.box.x, self.box.y]) + way).tolist()
        return replace(
            self,
            box=Box(x, y, self.box.w, self.box.h),
            velocity=velocity,
            covariance=covariance,
            patches=(),
            motion=None if self.motion is None else later,
        )


def lasting_deviation(score: float) -> float:
    """Deviation of a box's centre from its target's that no filter averages out.

    What a box misses its target by is learnt with it and stays. In x it is this much of the box's
    width, in y of its height.

    Args:
        score: probability that the box is right, 0..1.
    """
    return _LASTING + _BY_DOUBT * (1 - score)
