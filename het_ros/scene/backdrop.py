# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is far away: sky and hills all around, and the row of houses across the road."""

from __future__ import annotations

import cv2
import numpy as np

from het_ros.scene.camera import CameraState, Lens, plane_to_image, to_camera
from het_ros.scene.ground import FRONT
from het_ros.scene.pixels import cut_out, lay, overlap, warp_window
from het_ros.scene.texture import blocks, fractal, ring_fractal, tinted

GRAIN = 30  # texels a metre of the houses
LEFT, RIGHT, TALLEST = -36.0, 36.0, 9.5  # m: what the houses cover
RING = 480.0  # px a radian of the panorama
ABOVE, BELOW = 330, 60  # rows of the panorama over and under the horizon


class Panorama:
    """Sky, clouds, hills and trees on a cylinder at infinity."""

    def __init__(self, rng: np.random.Generator, lens: Lens) -> None:
        self._ring = _paint_ring(rng)
        columns = np.arange(lens.width, dtype=np.float32) + 0.5 - lens.width / 2
        self._columns = np.arctan2(columns, lens.focal) * RING
        self._stretch = RING / np.hypot(lens.focal, columns)

    def draw(self, image: np.ndarray, camera: CameraState, lens: Lens) -> None:
        """Fill the image from the top to just under the horizon, in place."""
        horizon = lens.horizon_row(camera)
        rows = int(np.clip(horizon + 12, 0, lens.height))
        if rows == 0:
            return
        across = np.mod(self._columns + camera.yaw * RING, self._ring.shape[1])
        down = (np.arange(rows) + 0.5 - horizon)[:, None] * self._stretch + ABOVE
        map_x = np.broadcast_to(across.astype(np.float32), down.shape)
        image[:rows] = cv2.remap(
            self._ring, np.ascontiguousarray(map_x), np.clip(down, 0, ABOVE + BELOW - 1)
            .astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP,
        )  # fmt: skip


def _paint_ring(rng: np.random.Generator) -> np.ndarray:
    width, height = int(2 * np.pi * RING), ABOVE + BELOW
    up = np.linspace(1, 0, ABOVE, dtype=np.float32)[:, None, None]
    sky = up * np.float32([205, 160, 105]) + (1 - up) * np.float32([232, 222, 205])
    ring = np.empty((height, width, 3), np.float32)
    ring[:ABOVE] = sky
    ring[ABOVE:] = (120, 150, 135)
    clouds = ring_fractal(rng, ABOVE, width, 130, 6)
    clouds += (
        0.6
        * cv2.resize(clouds, None, fx=1, fy=0.5)[
            [0] * (ABOVE - ABOVE // 2) + list(range(ABOVE // 2))
        ]
    )
    cover = np.clip(clouds * 0.55 - 0.1, 0, 1)[..., None]
    lit = 236 + 14 * np.roll(clouds, 6, axis=0)[..., None] - 26 * cover
    ring[:ABOVE] = ring[:ABOVE] * (1 - cover) + lit * cover
    angle = np.arange(width) / width * 2 * np.pi
    layers = [(46, 16, (178, 165, 140)), (30, 11, (140, 148, 118)), (17, 9, (78, 112, 88))]
    for mean, swing, colour in layers:
        waves = sum(
            np.sin(k * angle + rng.uniform(0, 2 * np.pi)) * swing / k**0.7 for k in range(2, 9)
        )
        rough = ring_fractal(rng, 1, width, 9, 3)[0] * swing * 0.16
        top = ABOVE - mean - waves * 0.5 - rough
        first = int(top.min())  # nothing of this layer lies above
        rows = np.arange(first, height, dtype=np.float32)[:, None]
        inside = np.clip(rows - top.astype(np.float32) + 0.5, 0, 1)[..., None]
        grain = 1 + 0.09 * ring_fractal(rng, height - first, width, 8, 3)[..., None]
        ring[first:] += (np.float32(colour) * grain - ring[first:]) * inside
    return np.clip(ring, 0, 255).astype(np.uint8)


class Houses:
    """The row of houses: one upright plane along x."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._front = _paint_houses(rng)

    def draw(self, image: np.ndarray, camera: CameraState, lens: Lens) -> None:
        """Lay the houses over the image, in place; what lies behind the camera is cut off."""
        ends = _clip_near(camera)
        if ends is None:
            return
        corners = np.array(
            [(x, y, FRONT) for x, y in zip(ends * 2, (0, 0, TALLEST, TALLEST), strict=True)]
        )
        right, up, depth = to_camera(corners, camera).T
        columns = lens.width / 2 + lens.focal * right / depth
        rows = lens.horizon_row(camera) - lens.focal * up / depth
        left, top = int(max(columns.min(), 0)), int(max(rows.min(), 0))
        width = int(min(np.ceil(columns.max()), lens.width)) - left
        height = int(min(np.ceil(rows.max()) + 1, lens.height)) - top
        if width <= 0 or height <= 0:
            return
        step = 1 / GRAIN
        plane = plane_to_image(
            np.array([LEFT, TALLEST, FRONT]), np.array([step, 0, 0]), np.array([0, -step, 0]),
            camera, lens,
        )  # fmt: skip
        lay(image, warp_window(self._front, plane, left, top, width, height), left, top)


def _clip_near(camera: CameraState) -> tuple[float, float] | None:
    """The part of the row, m, that lies at least 1 m in front of the camera."""
    sin, cos = np.sin(camera.yaw), np.cos(camera.yaw)
    reach = 1.0 - cos * (FRONT - camera.z)  # sin * (x - camera.x) must be over it
    if abs(sin) < 1e-9:
        return (LEFT, RIGHT) if reach < 0 else None
    edge = camera.x + reach / sin
    left, right = (max(LEFT, edge), RIGHT) if sin > 0 else (LEFT, min(RIGHT, edge))
    return (left, right) if left < right else None


WALLS = [(150, 178, 196), (118, 140, 178), (172, 190, 200), (96, 120, 160), (160, 168, 160),
         (128, 168, 190), (186, 186, 176)]  # fmt: skip


def _paint_houses(rng: np.random.Generator) -> np.ndarray:
    width, height = int((RIGHT - LEFT) * GRAIN), int(TALLEST * GRAIN)
    colour, alpha = np.zeros((height, width, 3), np.float32), np.zeros((height, width), np.float32)
    x = 0
    while x < width:
        span = min(int(rng.uniform(4.5, 8.5) * GRAIN), width - x)
        tall = int(rng.uniform(5.4, TALLEST - 1.2) * GRAIN)
        if span > 2 * GRAIN:
            _paint_house(rng, colour[:, x : x + span], alpha[:, x : x + span], tall)
        x += span + (int(rng.uniform(0.8, 2.0) * GRAIN) if rng.random() < 0.2 else 0)
    front = cut_out(colour, alpha)
    return cv2.GaussianBlur(front, (0, 0), 0.6)


def _paint_house(
    rng: np.random.Generator, colour: np.ndarray, alpha: np.ndarray, tall: int
) -> None:
    height, span = alpha.shape
    top = height - tall
    wall = np.asarray(WALLS[rng.integers(len(WALLS))], float) * rng.uniform(0.85, 1.08)
    weather = 1 + 0.05 * fractal(rng, tall, span, 60, 5)
    if rng.random() < 0.4:
        weather = weather * blocks(rng, tall, span, (4, 9), 1, 0.06)
    colour[top:] = tinted(tuple(wall), weather)
    alpha[top:] = 1
    roof = int(rng.uniform(0.5, 1.1) * GRAIN)
    tiles = blocks(rng, roof, span, (5, 6), 1, 0.07) * (1 + 0.05 * fractal(rng, roof, span, 20))
    colour[top - roof : top] = tinted(((62, 72, 122), (78, 76, 80))[rng.integers(2)], tiles)
    slope = np.minimum(np.arange(span), np.arange(span)[::-1])[None, :]
    alpha[top - roof : top] = (slope > (roof - np.arange(roof)[:, None]) * 0.5).astype(np.float32)
    cv2.rectangle(colour, (0, top), (span, top + 4), (wall * 1.15).tolist(), -1)
    colour[top + 5 : top + 9] *= 0.75
    _paint_openings(rng, colour, span, height, tall, wall)


def _paint_openings(
    rng: np.random.Generator,
    colour: np.ndarray,
    span: int,
    height: int,
    tall: int,
    wall: np.ndarray,
) -> None:
    storey = int(2.7 * GRAIN)
    count = max(int(span / (1.7 * GRAIN)), 1)
    pitch = span / count
    wide, high = int(0.95 * GRAIN), int(1.4 * GRAIN)
    frame = (225, 228, 230) if rng.random() < 0.7 else (70, 80, 92)
    for floor in range(1, tall // storey + 1):
        for k in range(count):
            x = int((k + 0.5) * pitch - wide / 2)
            y = height - floor * storey - high - int(0.35 * GRAIN)
            if y > height - tall + int(0.35 * GRAIN):
                _paint_window(rng, colour, x, y, wide, high, frame)
    door = rng.integers(count)
    shop = rng.random() < 0.45
    for k in range(count):
        x = int((k + 0.5) * pitch - wide / 2)
        if k == door:
            y = height - int(2.1 * GRAIN)
            tint = rng.uniform(40, 120, 3)
            cv2.rectangle(colour, (x - 3, y - 3), (x + wide + 3, height), frame, -1)
            cv2.rectangle(colour, (x, y), (x + wide, height), tint.tolist(), -1)
            cv2.rectangle(
                colour, (x + 5, y + 6), (x + wide - 5, y + 26), (tint * 0.6).tolist(), -1
            )
        elif not shop:
            _paint_window(rng, colour, x, height - int(2.2 * GRAIN), wide, high, frame)
    if shop:
        y = height - int(2.5 * GRAIN)
        for k in range(count):
            if k != door:
                x = int(k * pitch + 0.1 * pitch)
                _paint_window(rng, colour, x, y + 14, int(0.8 * pitch), 50, (60, 66, 70))
        stripes = (np.arange(span) // 9 % 2)[None, :, None]
        hue = rng.uniform(60, 190, 3)
        awning = np.where(stripes, hue, np.array([225, 228, 232]))
        fall = np.linspace(1.0, 0.72, 18)[:, None, None]
        colour[y - 6 : y + 12] = awning * fall
        colour[y + 12 : y + 16] *= 0.6
    colour[height - 8 :] = wall * 0.55


def _paint_window(
    rng: np.random.Generator,
    colour: np.ndarray,
    x: int,
    y: int,
    wide: int,
    high: int,
    frame: tuple[int, int, int],
) -> None:
    cv2.rectangle(colour, (x - 3, y - 3), (x + wide + 3, y + high + 3), frame, -1)
    glass = np.linspace(rng.uniform(95, 150), rng.uniform(30, 70), high)[:, None]
    pane = tinted((1.12, 1.0, 0.9), np.broadcast_to(glass, (high, wide)).astype(np.float32))
    if rng.random() < 0.5:  # curtains
        side = int(wide * rng.uniform(0.12, 0.3))
        pane[:, :side] = pane[:, :side] * 0.4 + 120
        pane[:, wide - side :] = pane[:, wide - side :] * 0.4 + 112
    window, inner = overlap(colour.shape, pane.shape, x, y)
    if window is not None:
        colour[window] = pane[inner]
    cv2.line(colour, (x + wide // 2, y), (x + wide // 2, y + high), frame, 2)
    cv2.line(colour, (x, y + high // 3), (x + wide, y + high // 3), frame, 1)
    cv2.rectangle(colour, (x - 5, y + high + 3), (x + wide + 5, y + high + 6), (190, 196, 200), -1)
