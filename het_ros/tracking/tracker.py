# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The default tracker: the layers joined, from an image to an estimate."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.ensemble import EnsembleFactory
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.images import check_image
from het_ros.tracking.target import Target

Image = NDArray[np.uint8]
Witness = Callable[[Box], bool]


class HierarchicalEnsembleTracker:
    """Follows one target through a stream of images.

    The same seed, boxes and images give the same estimates, to the bit, in every process of one
    machine.

    Args:
        config: its parameters; by default ``TrackerConfig()``.
        further: base ensembles of your own, each made anew for every target by a function of the
            first image and box. A place with the vote v, in 0..1, gains by a factor of 1 + v.
    """

    def __init__(
        self,
        config: TrackerConfig | None = None,
        further: Sequence[EnsembleFactory] = (),
    ) -> None:
        self.config = config or TrackerConfig()
        self._further = tuple(further)
        self._target: Target | None = None
        self._state = State.IDLE

    @property
    def state(self) -> State:
        """IDLE before :meth:`init` and after :meth:`reset`, else the last estimate's state."""
        return self._state

    @property
    def target(self) -> Target | None:
        """The model of the target that is followed."""
        return self._target

    def reset(self) -> None:
        """Forget the target."""
        self._target = None
        self._state = State.IDLE

    def init(self, image: Image, box: Box) -> Estimate:
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
        self._target = Target(self.config, image, box, further=self._further)
        self._state = State.TRACKING
        return self._target.estimate(1.0, State.TRACKING)

    def update(
        self,
        image: Image,
        dt: float,
        witness: Witness | None = None,
        candidates: Sequence[Box] = (),
    ) -> Estimate:
        """Find the target in the next image.

        A target that is not recognised is COASTING and after ``lost_after`` s LOST, until it is
        recognised again.

        Args:
            image: (H, W, 3) uint8 BGR or (H, W) uint8; size and kind may differ from the last.
            dt: time since the last image, s. Where it is not positive the configuration's
                ``nominal_dt`` is taken.
            witness: a measurement gate: another sensor, for example of depth. It is asked once a
                frame whether the target may be in the box where it was found; where it says no,
                the target counts as hidden, and nothing is learnt.
            candidates: boxes, image px, that another detector suggests: a hidden target is looked
                for there first. What is found is accepted by its confidence alone.

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
        estimate = self._target.follow(image, dt, witness, candidates)
        self._state = estimate.state
        return estimate
