# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What became of one frame."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.ros.frames import Frame
from het_ros.ros.images import Pixels
from het_ros.tracking.estimate import Estimate, State


@dataclass(frozen=True)
class Outcome:
    """One processed frame.

    Attributes:
        frame: the frame.
        pixels: its image, or None where nothing needed it.
        estimate: of this frame, or None without a track.
        published: whether it is to be published: not while it is older than what was.
        track: number of the track.
        state, reason, age: of the track after this frame, see :class:`TrackingSession`.
    """

    frame: Frame
    pixels: Pixels | None
    estimate: Estimate | None
    published: bool
    track: int
    state: State
    reason: str
    age: float
