# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The life of one track on a stream of frames: started, followed, lost. Knows no ROS."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.ros.stamps import SECOND
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.tracker import HierarchicalEnsembleTracker, Witness

if TYPE_CHECKING:
    from het_ros.tracking.paper.tracker import PaperTracker

Pixels = NDArray[np.uint8]
LARGEST_BOX = 2.0  # sides of the image: a larger box is a slip of units, and costs memory


class TrackingSession:
    """At most one track, and why there is none.

    A new box makes a new tracker and replaces the old one only once it has started, so a box
    that is refused leaves the running track as it was.

    Args:
        config: parameters of the default tracker.
        max_gap: s without an image that end a track.
        tracker: "het", or "paper" for the paper's with its own constants.

    Attributes:
        state: of the track; IDLE or LOST without one.
        reason: why the state is not TRACKING, in words; empty while it is.
        age: s since the target was last measured.
        box: where the target was last estimated, px; None without a track.
    """

    def __init__(self, config: TrackerConfig, max_gap: float, tracker: str = "het") -> None:
        self.config = config
        self.max_gap = max_gap
        self.tracker = tracker
        self.state = State.IDLE
        self.reason = "waiting for a box"
        self.age = 0.0
        self.box: Box | None = None
        self._tracker: HierarchicalEnsembleTracker | PaperTracker | None = None
        self._shape: tuple[int, ...] = ()
        self._source = ""
        self._stamp = 0
        self._seen = 0

    @property
    def running(self) -> bool:
        """Whether frames are needed: there is a track, even one that looks for its target."""
        return self._tracker is not None

    def start(self, image: Pixels, stamp: int, box: Box, source: str = "") -> Estimate:
        """Start a track on an image with the stamp (ns) of the camera frame ``source``.

        Raises:
            ValueError: the box does not fit the image; the track that runs goes on.
        """
        height, width = image.shape[:2]
        if box.w > LARGEST_BOX * width or box.h > LARGEST_BOX * height:
            raise ValueError(
                f"the box is {box.w:g} x {box.h:g} px, the image only {width} x {height} px: "
                "send pixels of the image that is tracked"
            )
        if not box.touches_image(width, height):
            raise ValueError(f"{box} lies wholly outside the image of {width} x {height} px")
        tracker = new_tracker(self.tracker, self.config)
        estimate = _finite(tracker.init(image, box))
        self._tracker, self._shape, self._source = tracker, image.shape, source
        self._stamp = self._seen = stamp
        self._take(estimate)
        return estimate

    def follow(
        self,
        image: Pixels,
        stamp: int,
        source: str = "",
        witness: Witness | None = None,
        candidates: Sequence[Box] = (),
    ) -> Estimate | None:
        """The estimate for the next frame, or None where there is no track or it ends here.

        ``witness`` and ``candidates`` are those of :meth:`HierarchicalEnsembleTracker.update`.
        """
        if self._tracker is None:
            return None
        gap = (stamp - self._stamp) / SECOND
        broken = self._break(image, gap, source)
        if broken:
            self.lose(broken)
            return None
        pixels = _with_channels_of(image, self._shape)
        more = {"candidates": candidates} if candidates else {}
        estimate = _finite(self._tracker.update(pixels, gap, witness, **more))
        self._stamp = stamp
        if estimate.state is State.TRACKING:
            self._seen = stamp
        self._take(estimate)
        return estimate

    def drop(self, reason: str) -> None:
        """End the track on purpose: IDLE."""
        self._end(State.IDLE, reason)

    def lose(self, reason: str) -> None:
        """End the track because it cannot go on: LOST until a new box comes."""
        self._end(State.LOST, reason)

    def _end(self, state: State, reason: str) -> None:
        self._tracker = None
        self.state, self.reason, self.age, self.box = state, reason, 0.0, None

    def _break(self, image: Pixels, gap: float, source: str) -> str:
        """Why the track cannot go on with this frame; empty where it can."""
        if gap > self.max_gap:
            return f"no image for {gap:.1f} s (max_gap is {self.max_gap:g} s): send a new box"
        if image.shape[:2] != self._shape[:2]:
            old, new = self._shape, image.shape
            return (
                f"the image changed from {old[1]} x {old[0]} to {new[1]} x {new[0]} px: "
                "send a new box"
            )
        if source != self._source:
            return (
                f"the images' frame_id changed from {self._source!r} to {source!r}: send a new box"
            )
        return ""

    def _take(self, estimate: Estimate) -> None:
        self.state, self.box = estimate.state, estimate.box
        self.age = (self._stamp - self._seen) / SECOND
        self.reason = "" if self.state is State.TRACKING else f"not seen for {self.age:.2f} s"


def new_tracker(name: str, config: TrackerConfig) -> HierarchicalEnsembleTracker | PaperTracker:
    """The tracker of a name, "het" or "paper"; of the parameters the paper's takes the seed."""
    if name == "het":
        return HierarchicalEnsembleTracker(config)
    from het_ros.tracking.paper.config import PaperConfig
    from het_ros.tracking.paper.tracker import PaperTracker

    return PaperTracker(PaperConfig(seed=config.seed))


def _finite(estimate: Estimate) -> Estimate:
    """The estimate, if there is no NaN in it that a robot could act on.

    Raises:
        FloatingPointError: there is.
    """
    numbers = (*estimate.velocity, estimate.score, *np.ravel(estimate.covariance))
    if not np.all(np.isfinite(numbers)):
        raise FloatingPointError(f"an estimate that is no number: {estimate}")
    return estimate


def _with_channels_of(image: Pixels, shape: tuple[int, ...]) -> Pixels:
    """The image as gray or BGR like the track's first one: a camera may change its encoding."""
    if image.ndim == len(shape):
        return image
    code = cv2.COLOR_GRAY2BGR if image.ndim == 2 else cv2.COLOR_BGR2GRAY
    return np.asarray(cv2.cvtColor(image, code), np.uint8)
