# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The Hierarchical Ensemble Tracker: the layers joined, from an image to an estimate."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.target import Target, Witness

Image = NDArray[np.uint8]


class HierarchicalEnsembleTracker:
    """Follows one target through a stream of images.

    The same seed, boxes and images give the same estimates, to the bit.

    Args:
        config: its parameters; by default ``TrackerConfig()``.
    """

    def __init__(self, config: TrackerConfig | None = None) -> None:
        self.config = config or TrackerConfig()
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
        _check_image(image)
        height, width = image.shape[:2]
        if not box.touches_image(width, height):
            raise ValueError(
                f"the box {box.as_tuple()} lies wholly outside the image of {width} x {height} "
                "px: send x, y, w, h in px of this image"
            )
        self._target = Target(self.config, image, box)
        self._state = State.TRACKING
        return self._target.estimate(1.0, State.TRACKING)

    def update(self, image: Image, dt: float, witness: Witness | None = None) -> Estimate:
        """Find the target in the next image.

        A target that is not seen is COASTING and after ``lost_after`` s LOST, until it is seen
        again. Without ``trust``, as in the paper, it is LOST when the estimated box leaves the
        image and stays so until the next :meth:`init`.

        Args:
            image: (H, W, 3) uint8 BGR or (H, W) uint8; size and kind may differ from the last.
            dt: time since the last image, s. Where it is not positive the configuration's
                ``nominal_dt`` is taken.
            witness: another sensor, for example of depth. Asked once a frame whether the target
                may be in the box where it was found; where it says no, the target counts as
                hidden, and nothing is learnt. Not asked without ``trust``.

        Returns:
            The estimate of this frame.

        Raises:
            ValueError: the image is not of that kind, or ``dt`` is NaN or infinite.
            RuntimeError: there is no target.
        """
        _check_image(image)
        if not math.isfinite(dt):
            raise ValueError(f"dt must be a finite number of seconds, not {dt}")
        if self._target is None:
            raise RuntimeError("there is no target to update: call init first")
        if self._state is State.LOST and not self.config.trust:
            return self._target.estimate(0.0, State.LOST)
        estimate = self._target.follow(image, dt, witness)
        self._state = estimate.state
        return estimate


def _check_image(image: Image) -> None:
    """Raise ValueError unless the image is (H, W, 3) or (H, W) uint8 with at least one px."""
    if not isinstance(image, np.ndarray) or image.dtype != np.uint8:
        kind = getattr(image, "dtype", type(image).__name__)
        raise ValueError(f"an image must be a uint8 array, not {kind}: convert it first")
    if image.size == 0 or image.ndim not in (2, 3) or (image.ndim == 3 and image.shape[2] != 3):
        raise ValueError(
            f"an image must be of shape (H, W, 3) in BGR order or (H, W), not {image.shape}"
        )
