# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Takes back what the camera does to the light from one image to the next.

Exposure and white balance that jump change all colours at once, and with them most of what was
learnt. What one brightness and one contrast a channel explain at most places of the search window
is the camera's doing; a target or a background that moves changes its places each in its own way.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]
Floats = NDArray[np.float64]

_GRID = 8  # places a side
_JUMP = 10.0  # levels: least change of the median place that is taken back
_LEFT = 0.5  # most of that change that may be left when it is taken back
_GAIN = 2.0  # a contrast that changed by more than this factor is another picture's
_AS_BEFORE = 5.0  # levels: what changes black and white by less is no change any more


@dataclass(frozen=True)
class Change:
    """Levels now are ``gain`` times the levels before plus ``offset``, both (channels,)."""

    gain: Floats
    offset: Floats

    def then(self, later: Change) -> Change:
        """This change and a later one together."""
        return Change(later.gain * self.gain, later.gain * self.offset + later.offset)

    def apply(self, levels: Floats) -> Floats:
        """Levels (..., channels) before as they are now."""
        return self.gain * levels + self.offset

    def undo(self, pixels: Pixels) -> Pixels:
        """Pixels (H, W, channels) or (H, W) uint8 as they would have been before."""
        levels = (np.arange(256)[:, None] - self.offset) / self.gain
        table = np.rint(levels).clip(0, 255).astype(np.uint8)
        return np.asarray(cv2.LUT(pixels, table[:, None]), np.uint8)


class Light:
    """Knows how the light of a target's windows has jumped since the first one."""

    def __init__(self) -> None:
        self._before: Floats | None = None
        self._change: Change | None = None

    def observe(self, pixels: Pixels) -> None:
        """Compare a window with the last one, which showed about the same.

        Args:
            pixels: (H, W, 3) or (H, W) uint8, as the camera gave them.
        """
        before, self._before = self._before, levels_of(pixels)
        if before is None or before.shape != self._before.shape:
            return
        jump = light_jump(before, self._before)
        if jump:
            change = self._change.then(jump) if self._change else jump
            ends = np.array([[0.0], [255.0]])
            small = np.abs(change.apply(ends) - ends).max() < _AS_BEFORE
            self._change = None if small else change

    def forget(self) -> None:
        """The next window shows something else."""
        self._before = None

    def undo(self, pixels: Pixels) -> Pixels:
        """A window in the light of the first one, uint8; the same array where that is today's."""
        return self._change.undo(pixels) if self._change else pixels


def levels_of(pixels: Pixels) -> Floats:
    """(places, channels): mean levels of a window (H, W, channels) or (H, W) on a coarse grid."""
    small = cv2.resize(pixels, (_GRID, _GRID), interpolation=cv2.INTER_AREA)
    return small.reshape(_GRID * _GRID, -1).astype(np.float64)


def light_jump(before: Floats, now: Floats) -> Change | None:
    """How the light jumped from one window to the next, or None where it did not.

    The change is fitted to the sorted levels, so that what only moved does not count, and
    believed where it explains at least half of what changed place by place.

    Args:
        before: (places, channels) levels.
        now: of the next window.
    """
    changed = _median(np.abs(now - before))
    if changed.max() < _JUMP:
        return None
    first, second = np.sort(before, axis=0), np.sort(now, axis=0)
    mean, spread = first.mean(axis=0), first.std(axis=0)
    shared = ((first - mean) * second).mean(axis=0)
    gain = shared / np.maximum(spread**2, 1e-6)
    if gain.min() < 1 / _GAIN or gain.max() > _GAIN:
        return None
    change = Change(gain, second.mean(axis=0) - gain * mean)
    left = _median(np.abs(now - change.apply(before)))
    most = int(changed.argmax())
    return change if left[most] < _LEFT * changed[most] else None


def _median(values: Floats) -> Floats:
    """Upper median of each column, many times faster than NumPy's for so few."""
    return np.asarray(np.sort(values, axis=0)[len(values) // 2])
