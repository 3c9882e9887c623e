# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a target that follow it slowly and never forget its first frame."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


class Memory:
    """Running means of arrays, with a share of the first frame in every new one.

    Args:
        rate: weight of the new frame, 0..1.
        first_frame: share of the first frame that every new frame is mixed with, 0..1.

    Attributes:
        values: the arrays as they are remembered; none before the first frame.
    """

    def __init__(self, rate: float, first_frame: float) -> None:
        self._rate = rate
        self._of_first = rate * first_frame
        self._first: tuple[NDArray[Any], ...] = ()  # of the first frame what is blended in again
        self.values: tuple[NDArray[Any], ...] = ()

    def __bool__(self) -> bool:
        """Whether anything was learnt."""
        return bool(self.values)

    def learn(self, *frame: NDArray[Any]) -> None:
        """Blend a frame's arrays in; those of the first frame are taken outright."""
        if not self.values:
            self._first = tuple(self._of_first * array for array in frame)
            self.values = tuple(np.array(array) for array in frame)
            return
        for value, fresh, first in zip(self.values, frame, self._first, strict=True):
            value *= 1 - self._rate
            value += (self._rate - self._of_first) * fresh
            value += first
