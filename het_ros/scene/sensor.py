# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the light, the shutter and the sensor do to an image."""

from __future__ import annotations

import cv2
import numpy as np

from het_ros.scene.camera import CameraState, Lens

SPOT = 0.62  # px: deviation of the spot that a lens and a Bayer pattern make of a point


class Sensor:
    """Softness, exposure, vignette, motion blur and noise.

    Args:
        noise: standard deviation at mid grey, grey levels.
        exposure: time the shutter is open, s.
    """

    def __init__(
        self, rng: np.random.Generator, lens: Lens, noise: float, exposure: float
    ) -> None:
        self._seed = int(rng.integers(2**31))
        self._lens, self._exposure = lens, exposure
        y, x = np.mgrid[: lens.height, : lens.width].astype(np.float32)
        radius = np.hypot(x / lens.width - 0.5, y / lens.height - 0.5)
        self._vignette = cv2.merge([(255 * (1 - 0.36 * radius**2)).astype(np.uint8)] * 3)
        size = (lens.height + 64, lens.width + 64, 3)
        grains = rng.standard_normal(size, np.float32)
        grains = 0.8 * grains + 0.35 * cv2.GaussianBlur(grains, (0, 0), 0.8)
        self._grains = (grains * noise).round().astype(np.int16) if noise > 0 else None

    def expose(
        self, image: np.ndarray, t: float, camera: CameraState, brightness: float
    ) -> np.ndarray:
        """The recorded image (H, W, 3) uint8 of what the lens shows, ``brightness`` 1 in sun."""
        image = self._smear(image, camera)
        image = cv2.multiply(image, self._vignette, scale=1 / 255)
        image = cv2.LUT(image, _response(brightness))
        if self._grains is None:
            return image
        moment = np.random.default_rng((self._seed, round(t * 1e6) & 0xFFFFFFFF))
        top, left = moment.integers(0, 64, 2)
        grains = self._grains[top : top + image.shape[0], left : left + image.shape[1]]
        return cv2.add(image, grains, dtype=cv2.CV_8U)

    def _smear(self, image: np.ndarray, camera: CameraState) -> np.ndarray:
        """What lens and shutter spread: a soft spot, drawn out while the camera pans."""
        spot = cv2.getGaussianKernel(5, SPOT)
        pixels = abs(camera.yaw_rate) * self._exposure * self._lens.focal
        reach = int(np.ceil(pixels / 2))
        trail = np.clip(pixels / 2 + 0.5 - np.abs(np.arange(-reach, reach + 1)), 0, 1)
        across = np.convolve(spot[:, 0], trail / trail.sum())
        return cv2.sepFilter2D(image, -1, across, spot)


def _response(brightness: float) -> np.ndarray:
    """Look-up table (256, 1, 3): less sun is darker and bluer."""
    warmth = np.array([1.0 + 0.10 * (1 - brightness), 1.0, 1.0 - 0.07 * (1 - brightness)])
    levels = np.arange(256)[:, None] * brightness * warmth
    rolled = np.where(levels > 220, 220 + (levels - 220) * 0.6, levels)
    table = np.clip(rolled, 0, 255).round().astype(np.uint8)
    return np.ascontiguousarray(table[:, None, :])
