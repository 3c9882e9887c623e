# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the tracker says of one frame."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box

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
        velocity: (vx, vy) of the box's centre, px/s.
        covariance: (4, 4) float64 of the state [cx, cy, vx, vy], px^2, px^2/s, px^2/s^2; with what
            a box misses its target by for good, which is more the lower the score.
        score: 0..1, how far the box can be trusted; 0 in LOST.
        state: TRACKING, COASTING or LOST.
        patches: the Q sub-patches of this frame; empty when nothing was measured.
    """

    box: Box
    velocity: tuple[float, float]
    covariance: NDArray[np.float64]
    score: float
    state: State
    patches: tuple[Patch, ...] = ()


def lasting_deviation(score: float) -> float:
    """Deviation of a box's centre from its target's that no filter averages out.

    What a box misses its target by is learnt with it and stays. In x it is this much of the box's
    width, in y of its height.

    Args:
        score: probability that the box is right, 0..1.
    """
    return _LASTING + _BY_DOUBT * (1 - score)
