# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which image a box starts on: a past one out of the ring, the newest, or one to come."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.ros.frames import Frame, FrameRing
from het_ros.ros.hints import Hints
from het_ros.ros.messages import BoxError
from het_ros.ros.stamps import SECOND
from het_ros.tracking.box import Box

ANOTHER_CLOCK = 60.0  # s: no detector is so late


@dataclass(frozen=True)
class Request:
    """A box and the stamp (ns) of the image it was drawn on; 0 takes any image."""

    box: Box
    stamp: int


class BoxRequests:
    """The box that waits for its image; a newer one takes its place.

    Attributes:
        waiting: that box, or None.
    """

    def __init__(self, hints: Hints) -> None:
        self.waiting: Request | None = None
        self._void: Request | None = None
        self._hints = hints

    def drop(self) -> None:
        """Forget all boxes."""
        self.waiting = self._void = None

    def jump_back(self) -> None:
        """Time went back: only a box that was refused for its age may still find its image."""
        self.waiting, self._void = self._void, None

    def wait(self, request: Request, newest: Frame | None, max_gap: float) -> None:
        """Let a box wait for its image, which comes after the ``newest`` one."""
        self.waiting = request
        if newest is None:
            self._hints.once(
                "early box", "a box came before any image: it starts on the first one"
            )
        elif request.stamp - newest.stamp > max_gap * SECOND:
            self._hints.once(
                "box ahead",
                f"a box is stamped {(request.stamp - newest.stamp) / SECOND:.2f} s after the "
                "newest image and waits for its own: do both clocks agree?",
            )

    def due(self, frame: Frame, tolerance: float) -> Box | None:
        """The box that starts on this frame, which waits no longer; None where none does.

        Raises:
            BoxError: its image did not come within ``tolerance`` s, and it waits no longer.
        """
        request = self.waiting
        if request is None or request.stamp > frame.stamp:
            return None
        self.waiting = None
        late = (frame.stamp - request.stamp) / SECOND if request.stamp else 0.0
        if late > tolerance:
            raise BoxError(f"its image did not come, the next one is {late:.2f} s later")
        return request.box

    def image_of(self, request: Request, ring: FrameRing, tolerance: float) -> Frame:
        """The image in the ring that a box was drawn on; the newest for one without a stamp.

        Raises:
            BoxError: none is within ``tolerance`` s of the box's stamp.
        """
        newest, nearest = ring.newest, ring.nearest(request.stamp)
        if newest is None or nearest is None:
            raise BoxError("there is no image to start it on")
        if request.stamp == 0:
            return newest
        off = abs(nearest.stamp - request.stamp) / SECOND
        if off <= tolerance:
            return nearest
        self._void = request
        age = (newest.stamp - request.stamp) / SECOND
        if age > ANOTHER_CLOCK:
            raise BoxError(
                f"its stamp is {age:.0f} s before the newest image's, which is another clock: "
                "copy the header of the image that it was drawn on, or leave the stamp at zero"
            )
        if age > ring.span:
            raise BoxError(
                f"it was drawn on an image {age:.2f} s older than the newest, and images are kept "
                f"for {ring.span:.2f} s: send boxes sooner, or raise ring_seconds "
                "and ring_megabytes"
            )
        raise BoxError(
            f"no image came within {tolerance:g} s of its stamp, the nearest is {off:.2f} s away"
        )
