# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The ground: lawn, promenade, verge, road and pavement on one plane."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from het_ros.scene.camera import CameraState, Lens, plane_to_image
from het_ros.scene.pixels import warp_window
from het_ros.scene.texture import blocks, fractal, tinted

GRAIN = 32  # texels a metre
LEFT, RIGHT, BACK, FRONT = -32.0, 32.0, -8.0, 20.0  # m: what the texture covers
PROMENADE, VERGE, ROAD, PAVEMENT = 2.7, 8.2, 10.4, 17.0  # z where each strip begins, m
DETAIL_GRAIN, DETAIL_SIDE = 160, 512  # fine grain laid over what is near: texels a metre, px
BANDS = (0.0, 3.2, 4.6, 6.8, 10.0, 14.5, np.inf)  # distances between which one blur serves, m


class Ground:
    """The textured ground with the shadows of what stands on it.

    Args:
        shadows: (x, z, radius, height) of round crowns or poles that shade the ground, m.
    """

    def __init__(self, rng: np.random.Generator, shadows: Sequence[tuple[float, ...]]) -> None:
        texture = _paint(rng)
        texture *= _shade(texture.shape[:2], shadows)[..., None]
        base = np.clip(texture, 0, 255).astype(np.uint8)
        self._blurred = [base, *(_flatten(base, near) for near in BANDS[1:-1])]
        fine = fractal(rng, DETAIL_SIDE, DETAIL_SIDE, 6, 2)
        self._detail = np.clip(128 + 6 * fine, 0, 255).astype(np.uint8)

    def draw(self, image: np.ndarray, camera: CameraState, lens: Lens) -> None:
        """Fill the image below the horizon, in place."""
        step = 1 / GRAIN
        plane = plane_to_image(
            np.array([LEFT, 0, FRONT]), np.array([step, 0, 0]), np.array([0, 0, -step]),
            camera, lens,
        )  # fmt: skip
        horizon = lens.horizon_row(camera)
        rows = [_row_at(far, horizon, camera, lens) for far in BANDS]
        for texture, below, above in zip(self._blurred, rows, rows[1:], strict=False):
            top, bottom = max(above, 0), min(below, lens.height)
            if bottom > top:
                image[top:bottom] = warp_window(texture, plane, 0, top, lens.width, bottom - top)
        self._draw_detail(image, max(rows[2], 0), camera, lens)

    def _draw_detail(self, image: np.ndarray, top: int, camera: CameraState, lens: Lens) -> None:
        if top >= lens.height:
            return
        step = 1 / DETAIL_GRAIN
        plane = plane_to_image(
            np.zeros(3), np.array([step, 0, 0]), np.array([0, 0, -step]), camera, lens
        )
        size = (lens.width, lens.height - top)
        shift = np.array([[1, 0, 0.5], [0, 1, top + 0.5], [0, 0, 1.0]])
        grain = cv2.warpPerspective(
            self._detail,
            np.linalg.inv(plane) @ shift,
            size,
            flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_WRAP,
        )
        lower = image[top:]
        cv2.multiply(lower, cv2.cvtColor(grain, cv2.COLOR_GRAY2BGR), dst=lower, scale=1 / 128)


def _row_at(distance: float, horizon: float, camera: CameraState, lens: Lens) -> int:
    if distance == 0:
        return lens.height
    return int(np.ceil(horizon + lens.focal * camera.height / distance))


def _flatten(texture: np.ndarray, distance: float) -> np.ndarray:
    """What a pixel at that distance averages: far along z, little along x (a 640 px image)."""
    across, along = distance / 530 * GRAIN, distance**2 / 600 * GRAIN
    return cv2.GaussianBlur(texture, (0, 0), max(0.3 * across, 0.3), sigmaY=0.35 * along)


def _rows(z_from: float, z_to: float) -> slice:
    """Rows of the texture between two depths, m."""
    return slice(int((FRONT - z_to) * GRAIN), int((FRONT - z_from) * GRAIN))


def _paint(rng: np.random.Generator) -> np.ndarray:
    width, height = int((RIGHT - LEFT) * GRAIN), int((FRONT - BACK) * GRAIN)
    broad = _broad(rng, height, width, 4 * GRAIN)
    fine = fractal(rng, height, width, 5, 3)
    texture = tinted((62, 118, 98), 1 + 0.13 * broad + 0.2 * fine)  # lawn
    dry = np.clip(_broad(rng, height, width, 2 * GRAIN) * 0.5, 0, 1)[..., None]
    texture = texture * (1 - 0.5 * dry) + np.array([88, 150, 158], np.float32) * 0.5 * dry
    strips = [
        (PROMENADE, VERGE, (150, 166, 176), (0.6, 0.9), 0.05, 1.0),
        (ROAD, PAVEMENT, (92, 90, 88), None, 0.03, 0.8),
        (PAVEMENT, FRONT, (142, 146, 150), (0.4, 0.4), 0.05, 1.0),
    ]
    for begin, end, colour, slab, spread, stain in strips:
        rows = _rows(begin, end)
        light = 1 + 0.05 * stain * broad[rows] + 0.035 * fine[rows]
        if slab is not None:
            size = (int(slab[0] * GRAIN), int(slab[1] * GRAIN))
            light *= blocks(rng, *light.shape, size, 1, spread)
        texture[rows] = tinted(colour, light)
    for kerb in (PROMENADE, VERGE, ROAD, PAVEMENT):
        rows = _rows(kerb - 0.08, kerb + 0.08)
        light = 1 + 0.04 * fine[rows]
        light[:, ::GRAIN] *= 0.7
        texture[rows] = tinted((178, 184, 188), light)
    middle = _rows(13.6, 13.75)
    dashes = (np.arange(width) // GRAIN) % 6 < 3
    texture[middle][:, dashes] = tinted((205, 212, 215), 1 + 0.08 * fine[middle])[:, dashes]
    _scatter_leaves(rng, texture)
    _fade_edges(texture)
    return texture


def _broad(rng: np.random.Generator, height: int, width: int, cell: float) -> np.ndarray:
    """Coarse noise (height, width), made small and grown."""
    small = fractal(rng, height // 4, width // 4, cell / 4, 4)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)


def _fade_edges(texture: np.ndarray) -> None:
    """Make the outermost texels plain, for they are what stretches to the horizon."""
    lawn = np.array([70, 122, 105], np.float32)
    reach = 3 * GRAIN
    fade = np.linspace(0, 1, reach, dtype=np.float32)
    texture[-reach:] = texture[-reach:] * (1 - fade)[:, None, None] + lawn * fade[:, None, None]
    texture[:3] = lawn * 0.8
    for edge, weight in ((texture[:, :reach], fade[::-1]), (texture[:, -reach:], fade)):
        plain = edge.mean(axis=1, keepdims=True)
        edge[:] = edge * (1 - weight)[None, :, None] + plain * weight[None, :, None]


def _scatter_leaves(rng: np.random.Generator, texture: np.ndarray) -> None:
    colours = np.array([(40, 90, 170), (50, 140, 200), (45, 70, 120), (60, 130, 140)], float)
    for _ in range(1700):
        x = int(rng.uniform(0, texture.shape[1]))
        y = int((FRONT - rng.uniform(0.5, ROAD)) * GRAIN)
        axes = (int(rng.integers(1, 3)), 1)
        colour = colours[rng.integers(len(colours))] * rng.uniform(0.7, 1.1)
        cv2.ellipse(texture, (x, y), axes, rng.uniform(0, 180), 0, 360, colour.tolist(), -1)


def _shade(shape: tuple[int, int], shadows: Sequence[tuple[float, ...]]) -> np.ndarray:
    """Brightness (h, w) under the shadows, which fall along ``SUN``."""
    shade = np.zeros(shape, np.float32)
    for x, z, radius, height in shadows:
        tip = shadow_of(np.array([x, height, z]))
        foot = _texel(x, z)
        cv2.line(shade, foot, _texel(tip[0], tip[2]), 1.0, max(int(0.5 * radius * GRAIN), 2))
        if radius > 0.8:  # a crown of leaves
            axes = (int(1.1 * radius * GRAIN), int(0.9 * radius * GRAIN))
            cv2.ellipse(shade, _texel(tip[0], tip[2]), axes, 0, 0, 360, 0.85, -1)
    return 1 - 0.42 * cv2.GaussianBlur(shade, (0, 0), 3.0)


SUN = np.array([0.62, -1.0, 0.28])  # where the sun's light goes, a metre down, m


def shadow_of(points: np.ndarray) -> np.ndarray:
    """Where the shadows of points (..., 3) m fall on the ground."""
    return points + points[..., 1:2] * SUN


def _texel(x: float, z: float) -> tuple[int, int]:
    return int((x - LEFT) * GRAIN), int((FRONT - z) * GRAIN)
