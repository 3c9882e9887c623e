# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Exponential averages that keep a share of their first frame."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray


class RunningMean:
    """Running means of arrays, with a share of the first frame in every new one.

    Args:
        rate: weight of the new frame, 0..1.
        first_frame: share of the first frame that every new frame is mixed with, 0..1.

    Attributes:
        values: the means; none before the first frame.
    """

    def __init__(self, rate: float, first_frame: float) -> None:
        self._rate, self._of_first = rate, first_frame
        self._first: tuple[NDArray[Any], ...] = ()
        self.values: tuple[NDArray[Any], ...] = ()

    def learn(self, *frame: NDArray[Any], weight: float = 1.0) -> None:
        """Blend a frame's arrays in; those of the first frame are taken outright.

        Args:
            frame: arrays of the same shapes in every call.
            weight: 0..1, of this frame.
        """
        if not self.values:
            self._first = self.values = frame
            return
        rate = self._rate * weight
        fresh, old = rate * (1 - self._of_first), rate * self._of_first
        self.values = tuple(
            (1 - rate) * value + fresh * new + old * first
            for value, new, first in zip(self.values, frame, self._first, strict=True)
        )
