# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What one frame is turned into, for all layers to read and none to write."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.features.compressive import FeatureMaps
from het_ros.tracking.features.window import Pixels, Window

_Kind = TypeVar("_Kind", bound=np.generic)


@dataclass(frozen=True)
class Frame:
    """One image's search window, its channels and its compressive features.

    Made by :meth:`of`, which sees to it that no array in it can be written, through the frame
    or otherwise: it holds for as long as somebody keeps it.

    Attributes:
        window: the pixels, with its places counted in cells.
        channels: C planes (H, W) uint8, one value a cell.
        stack: (H, C, W) float32, the same row by row.
        features: (m, rows, columns), the features of a sub-patch with its corner in each cell.
    """

    window: Window
    channels: tuple[Pixels, ...]
    stack: NDArray[np.float32]
    features: FeatureMaps

    @classmethod
    def of(cls, window: Window, channels: Sequence[Pixels], features: FeatureMaps) -> Frame:
        """A frame of these arrays.

        What owns its memory is taken as it is and must not be written any more by the caller (an
        attempt raises ValueError); what is a view, for example of the image, is copied.
        """
        pixels = _sealed(window.pixels)
        planes = tuple(_sealed(channel) for channel in channels)
        stack = _sealed(stacked(planes))
        return cls(replace(window, pixels=pixels), planes, stack, _sealed(features))


def stacked(channels: Sequence[Pixels]) -> NDArray[np.float32]:
    """C planes (H, W) as one array (H, C, W) float32: whole rows of all channels are one piece."""
    return np.stack(channels, axis=1, dtype=np.float32)


def _sealed(array: NDArray[_Kind]) -> NDArray[_Kind]:
    """The array, or a copy where it is a view of another one's memory; not to be written."""
    sealed = array if array.flags.owndata else array.copy()
    sealed.setflags(write=False)
    return sealed
