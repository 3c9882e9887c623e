# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A background model of keyframes: whether what was found stood there before the target came.

A post that hides the target may look so much like it that shape and colours speak for it. But it
stood at its place while the target was still on its way there: keyframes of the last seconds show
it. So what was found is compared with its own place in them (moved with the camera, where the
target was elsewhere), and with the target's place. What fits the first better is not the target.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.features.window import cut_window

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]


@dataclass(frozen=True)
class BackgroundConfig:
    """Constants of the background model.

    Attributes:
        target_side: side of the target in a keyframe, px (chosen: enough to tell two patches
            apart, and small enough for a dozen keyframes).
        longest_side: of a keyframe, px (chosen: memory).
        smallest_patch: side below which a patch is not compared, px (chosen: smaller ones look
            like anything).
        every: time of view between two keyframes, s (chosen: a person walks half a width).
        kept: keyframes (chosen: those of the last 3 s of view).
        compared: of them at most for a place, and for the target (chosen: time).
        not_now: s; what a place looked like less than this ago says nothing of whether something
            stood there before (chosen: a keyframe's time) ...
        not_lately: ... nor what the target looked like less than this ago (chosen: what hides it
            comes over it within that time).
        elsewhere: distance of two boxes over their mean side, in x or y, from which on they
            hardly overlap (geometry: a quarter of the side is left).
        camera_error: how far off a place may be in an older keyframe, target sides (chosen: what
            the errors of ego-motion add up to).
        target_error: the same of the target's own place, target sides (chosen: what a box is off
            by).
        alike: correlation from which on two patches show the same (chosen).
        clearly: by how much more than with the target it must be (chosen: noise of both).
    """

    target_side: float = 20.0
    longest_side: float = 256.0
    smallest_patch: int = 4
    every: float = 0.25
    kept: int = 12
    compared: int = 5
    not_now: float = 0.3
    not_lately: float = 0.7
    elsewhere: float = 0.75
    camera_error: float = 0.4
    target_error: float = 0.15
    alike: float = 0.8
    clearly: float = 0.1


@dataclass(frozen=True)
class Keyframe:
    """The whole image at a moment when the target was in view.

    Attributes:
        pixels: (h, w) or (h, w, 3) uint8.
        at: (x, y), image px: how far the scene had moved with the camera by then.
        box: the target in it, image px.
        time: s of view until then.
    """

    pixels: Image
    at: Floats
    box: Box
    time: float


Place = tuple[Keyframe, Floats]  # and the corner (x, y) of a place in it, image px


class Background:
    """Remembers what the scene looked like around the target.

    Args:
        shape: (H, W, ...) of the images.
        side: sqrt(w h) of the target, px.
    """

    def __init__(self, shape: tuple[int, ...], side: float) -> None:
        config = self._config = BackgroundConfig()
        self._shape = shape[:2]
        self._scale = min(1.0, config.target_side / side, config.longest_side / max(self._shape))
        self._keyframes: deque[Keyframe] = deque(maxlen=config.kept)
        self._at: Floats = np.zeros(2)
        self._time = 0.0

    def move(self, shift: Floats) -> None:
        """The camera moved the scene by ``shift`` (x, y), image px."""
        self._at = self._at + shift

    def remember(self, image: Image, box: Box, dt: float) -> None:
        """The target is in view.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            box: the target in it.
            dt: time since the last image, s.
        """
        if image.shape[:2] != self._shape:
            self._shape = image.shape[:2]
            self._keyframes.clear()
        self._time += dt
        if self._keyframes and self._time - self._keyframes[-1].time < self._config.every:
            return
        least = self._config.smallest_patch
        height, width = (max(least, round(side * self._scale)) for side in self._shape)
        pixels = cut_window(image, 0.0, 0.0, width, height, (self._scale, self._scale)).pixels
        self._keyframes.append(Keyframe(pixels.copy(), self._at, box, self._time))

    def shows(self, image: Image, box: Box) -> bool:
        """Whether what is in ``box`` now stood there before, and does not look like the target.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            box: what was found in it, image px.
        """
        if image.shape[:2] != self._shape:
            return False
        config, patch = self._config, self._patch(image, box)
        if min(patch.shape[:2]) < config.smallest_patch:
            return False
        size = np.array([box.w, box.h])
        place = np.array([box.x, box.y]) - self._at
        latest_first = tuple(reversed(self._keyframes))
        before = (
            (one, place + one.at)
            for one in latest_first
            if self._time - one.time > config.not_now and not self._was_target(one, box)
        )
        stood = self._best_of(before, patch, config.camera_error * size)
        if stood <= config.alike:
            return False
        # The oldest shows what was given, however lately that was.
        of_target = [
            one for one in latest_first if self._time - one.time > config.not_lately
        ] or latest_first[-1:]
        target = ((one, np.array(one.box.centre) - size / 2) for one in of_target)
        return stood > self._best_of(target, patch, config.target_error * size) + config.clearly

    def _best_of(self, places: Iterable[Place], patch: Image, error: Floats) -> float:
        """Highest correlation of a patch with the first places that keyframes show, or -1."""
        fits = (
            best_fit(one.pixels, corner * self._scale, patch, error * self._scale)
            for one, corner in places
        )
        shown = (fit for fit in fits if fit is not None)
        return max(islice(shown, self._config.compared), default=-1.0)

    def _patch(self, image: Image, box: Box) -> Image:
        """What is in the box, as small as in a keyframe."""
        width, height = round(box.w * self._scale), round(box.h * self._scale)
        if min(width, height) < 1:
            return image[:0]
        scale = (self._scale, self._scale)
        return cut_window(image, box.x, box.y, width, height, scale).pixels

    def _was_target(self, one: Keyframe, box: Box) -> bool:
        """Whether the target's box in a keyframe covered much of what is in ``box`` now."""
        config = self._config
        (x, y), (then_x, then_y) = box.centre, one.box.centre
        moved_x, moved_y = (self._at - one.at).tolist()
        return bool(
            abs(then_x + moved_x - x) <= config.elsewhere * (one.box.w + box.w) / 2
            and abs(then_y + moved_y - y) <= config.elsewhere * (one.box.h + box.h) / 2
        )


def best_fit(pixels: Image, corner: Floats, patch: Image, error: Floats) -> float | None:
    """Correlation of a patch with an image around a place, or None where that lies outside.

    Args:
        pixels: (H, W) or (H, W, 3) uint8.
        corner: (x, y) of the place, px.
        patch: (h, w) or (h, w, 3) uint8.
        error: (x, y), px: how far from there the best fit may be.
    """
    if pixels.ndim != patch.ndim:
        return None
    ranges = []
    for start, more, length, limit in zip(
        corner.tolist()[::-1], error.tolist()[::-1], patch.shape, pixels.shape, strict=False
    ):
        first, margin = round(start), math.ceil(more)
        low, high = max(first - margin, 0), min(first + length + margin, limit)
        if high - low < length:
            return None
        ranges.append(slice(low, high))
    around = pixels[ranges[0], ranges[1]]
    return float(cv2.matchTemplate(around, patch, cv2.TM_CCOEFF_NORMED).max())
