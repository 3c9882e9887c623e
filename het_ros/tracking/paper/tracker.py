# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's tracker: from an image to an estimate."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.features.window import Pixels
from het_ros.tracking.images import check_image
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.paper.target import Target


class PaperTracker:
    """Follows one target through a stream of images, as the paper has it.

    The same seed, boxes and images give the same estimates, to the bit.

    Args:
        config: its parameters; by default ``PaperConfig()``.
    """

    def __init__(self, config: PaperConfig | None = None) -> None:
        self.config = config or PaperConfig()
        self._target: Target | None = None
        self._state = State.IDLE

    @property
    def state(self) -> State:
        """IDLE before :meth:`init` and after :meth:`reset`, else the last estimate's state."""
        return self._state

    def reset(self) -> None:
        """Forget the target."""
        self._target = None
        self._state = State.IDLE

    def init(self, image: Pixels, box: Box) -> Estimate:
        """Start on a target; a target that was followed before is forgotten.

        Args:
            image: (H, W, 3) uint8 BGR or (H, W) uint8.
            box: the target in it; it may reach over the border.

        Returns:
            The estimate of this first frame.

        Raises:
            ValueError: the image is not of that kind, or the box lies wholly outside it, or
                would take more than ``most_memory``. The target followed before stays.
        """
        check_image(image, box)
        self._target = Target(self.config, image, box)
        self._state = State.TRACKING
        return self._target.estimate(1.0, State.TRACKING)

    def update(
        self,
        image: Pixels,
        dt: float,
        witness: Callable[[Box], bool] | None = None,
        candidates: Sequence[Any] = (),
    ) -> Estimate:
        """Find the target in the next image.

        The target is LOST when the estimated box leaves the image, and stays so until the next
        :meth:`init`.

        Args:
            image: (H, W, 3) uint8 BGR or (H, W) uint8; size and kind may differ from the last.
            dt: time since the last image, s. Where it is not positive the configuration's
                ``nominal_dt`` is taken.
            witness: ignored; here so that both trackers are called alike.
            candidates: ignored likewise.

        Returns:
            The estimate of this frame.

        Raises:
            ValueError: the image is not of that kind, or ``dt`` is NaN or infinite.
            RuntimeError: there is no target.
        """
        check_image(image)
        if not math.isfinite(dt):
            raise ValueError(f"dt must be a finite number of seconds, not {dt}")
        if self._target is None:
            raise RuntimeError("there is no target to update: call init first")
        if self._state is State.LOST:
            return self._target.estimate(0.0, State.LOST)
        estimate = self._target.follow(image, dt)
        self._state = estimate.state
        return estimate
