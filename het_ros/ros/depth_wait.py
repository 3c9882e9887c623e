# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How long an image waits for the depth image that belongs to it.

Depth that is registered to a camera is computed, and so it comes some ms after the image with the
same stamp. An image that does not wait for it is judged by the depth of the image before, or by
none. An image that waits where no depth is to come is late for nothing.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

import numpy as np

from het_ros.ros.stamps import SECOND

SAME = 0.001  # s: stamps this near are of one exposure
KEPT = 8  # stamps of depth, and of images
SILENT = 1.0  # s without any depth image: no one is waited for
STRANGE = 1.0  # s between the stamps of image and newest depth: another clock, or none
WORTH = 0.75  # a depth image that is to come must be as much nearer than the newest one
DISORDER = 5.0  # s since depth images changed places on the way: it may happen again
VAIN = 5  # waits in a row that brought nothing: depth comes too late to be waited for


class DepthWait:
    """Tells for each image whether its depth is still to be waited for.

    Stamps are ns, all other times s of one monotonic clock.

    Attributes:
        limit: s that an image waits at most; 0: none waits.

    Args:
        limit: see above.
        clock: monotonic, s.
    """

    def __init__(self, limit: float, clock: Callable[[], float] = time.monotonic) -> None:
        self.limit = limit
        self._clock = clock
        self._depths: deque[int] = deque(maxlen=KEPT)
        self._came = -np.inf
        self._images: deque[tuple[int, float]] = deque(maxlen=KEPT)
        self._vain = 0
        self._disorder = -np.inf

    def depth(self, stamp: int) -> None:
        """Take the stamp of a depth image that came."""
        if self._depths and stamp < self._depths[-1] - STRANGE * SECOND:
            self._depths.clear()  # time went back
        self._came = self._clock()
        if self._depths and stamp < max(self._depths):
            self._disorder = self._came
        self._depths.append(stamp)
        for image, arrival in self._images:
            if abs(image - stamp) <= SAME * SECOND and self._came - arrival < self.limit:
                self._vain = 0

    def left(self, stamp: int, arrival: float) -> float:
        """How much longer the image of a stamp, which came at ``arrival``, is to wait, s.

        0 where its depth is there, or is not to be expected in time.
        """
        if not self._images or self._images[-1][0] != stamp:
            self._images.append((stamp, arrival))
        if not self._expected(stamp):
            return 0.0
        left = arrival + self.limit - self._clock()
        if left <= 0:
            self._vain += 1
        return max(left, 0.0)

    @property
    def in_vain(self) -> bool:
        """Whether images wait no longer, because depth came too late again and again."""
        return self._vain >= VAIN

    def _expected(self, stamp: int) -> bool:
        """Whether a depth image is likely to come that is nearer to the image than those here."""
        now = self._clock()
        if self.limit <= 0 or not self._depths or now - self._came > SILENT or self.in_vain:
            return False
        if any(abs(depth - stamp) <= SAME * SECOND for depth in self._depths):
            return False
        ahead = (stamp - max(self._depths)) / SECOND
        if abs(ahead) > STRANGE or (ahead < 0 and now - self._disorder > DISORDER):
            return False
        interval = self._interval()
        off = ahead % interval
        # Depth at half the rate is as near to every second image before it as after it.
        return min(off, interval - off) < (WORTH * ahead if ahead > 0 else SAME)

    def _interval(self) -> float:
        """Usual time between two depth images, s."""
        steps = np.diff(sorted(self._depths)) / SECOND
        steps = steps[steps > SAME]
        return float(np.median(steps)) if steps.size else STRANGE
