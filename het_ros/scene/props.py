# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Things that stand in the street: trees, lamps, bushes, posts. Each is a flat cut-out."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from het_ros.scene.camera import NEAR, Lens
from het_ros.scene.pixels import cut_out, pyramid
from het_ros.scene.texture import fractal, tinted

GRAIN = 90  # texels a metre


@dataclass(frozen=True)
class Placed:
    """A cut-out that stands on the ground and always faces the camera.

    Attributes:
        levels: the cut-out and its halves, from :func:`het_ros.scene.pixels.pyramid`.
        x, z: where it stands, m.
        width, height: its size, m.
    """

    levels: list[np.ndarray]
    x: float
    z: float
    width: float
    height: float

    def drawn(
        self, column: float, row: float, depth: float, lens: Lens
    ) -> tuple[np.ndarray, int, int] | None:
        """The cut-out as seen with its corner's column and row, or None if it is not seen.

        Args:
            column: of its foot in the image, px.
            row: of its foot in the image, px.
            depth: its distance, m.
            lens: through which it is seen.
        """
        if depth < NEAR:
            return None
        scale = lens.focal / depth
        width, height = self.width * scale, self.height * scale
        left, top = column - width / 2, row - height
        first, last = max(int(np.floor(left)), 0), min(int(np.ceil(left + width)) + 1, lens.width)
        above, below = max(int(np.floor(top)), 0), min(int(np.ceil(row)) + 1, lens.height)
        if first >= last or above >= below:
            return None
        wanted = self.levels[0].shape[1] / width
        level = int(np.clip(np.floor(np.log2(max(wanted, 1e-6)) + 0.3), 0, len(self.levels) - 1))
        picture = self.levels[level]
        rate_x, rate_y = picture.shape[1] / width, picture.shape[0] / height
        inverse = np.array(
            [
                [rate_x, 0, (first + 0.5 - left) * rate_x - 0.5],
                [0, rate_y, (above + 0.5 - top) * rate_y - 0.5],
            ]
        )
        size = (last - first, below - above)
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        return cv2.warpAffine(picture, inverse, size, flags=flags), first, above


def placed(picture: np.ndarray, x: float, z: float, height: float) -> Placed:
    """A cut-out placed at (x, z) m, as tall as ``height`` m, with its own aspect."""
    framed = cv2.copyMakeBorder(picture, 4, 0, 4, 4, cv2.BORDER_CONSTANT)
    grown = height * framed.shape[0] / picture.shape[0]
    return Placed(pyramid(framed), x, z, grown * framed.shape[1] / framed.shape[0], grown)


def _rounded(width: int, height: int) -> np.ndarray:
    """Brightness (height, width) of an upright cylinder lit from the left."""
    across = np.linspace(-0.98, 0.98, width)
    light = 0.5 + 0.62 * np.clip(-0.65 * across + 0.76 * np.sqrt(1 - across**2), 0, 1)
    return np.broadcast_to(light, (height, width)).astype(np.float32)


def tree(rng: np.random.Generator, tall: float = 5.0) -> np.ndarray:
    """Cut-out of a tree with a leafy crown, ``tall`` m."""
    height, width = int(tall * GRAIN), int(tall * 0.72 * GRAIN)
    colour, alpha = np.zeros((height, width, 3), np.float32), np.zeros((height, width), np.float32)
    _draw_trunk(rng, colour, alpha)
    crown_y, crown_r = 0.34 * height, 0.30 * height
    order = np.sort(rng.uniform(0, 1, 900))
    for k in order:
        angle, far = rng.uniform(0, 2 * np.pi), np.sqrt(rng.uniform(0, 1))
        x = width / 2 + np.cos(angle) * far * crown_r * 1.12 * (0.9 + 0.2 * np.sin(3 * angle))
        y = crown_y + np.sin(angle) * far * crown_r * (0.95 + 0.12 * np.cos(5 * angle))
        lit = 0.62 - 0.28 * (y - crown_y) / crown_r - 0.16 * (x - width / 2) / crown_r
        tone = np.clip(lit + 0.22 * (k - 0.5) + rng.normal(0, 0.1), 0.42, 1.2)
        leaf = np.array([52, 128, 98]) * tone + np.array([0, 14, 18]) * rng.normal(0, 1)
        axes = (int(rng.uniform(5, 15)), int(rng.uniform(4, 10)))
        spot = (int(x), int(y))
        turn = rng.uniform(0, 180)
        cv2.ellipse(
            colour, spot, axes, turn, 0, 360, np.clip(leaf, 0, 255).tolist(), -1, cv2.LINE_AA
        )
        cv2.ellipse(alpha, spot, axes, turn, 0, 360, 1.0, -1, cv2.LINE_AA)
    colour *= (1 + 0.16 * fractal(rng, height, width, 5, 2))[..., None]
    return cut_out(colour, alpha)


def _draw_trunk(rng: np.random.Generator, colour: np.ndarray, alpha: np.ndarray) -> None:
    height, width = alpha.shape
    stem = max(int(0.034 * height), 6)
    left, top = width // 2 - stem // 2, int(0.4 * height)
    bark = 1 + 0.2 * cv2.resize(
        fractal(rng, (height - top) // 4 + 1, stem, 5, 3), (stem, height - top)
    )
    colour[top:, left : left + stem] = tinted((58, 76, 98), _rounded(stem, height - top) * bark)
    alpha[top:, left : left + stem] = 1
    for side in (-1, 1):
        knee = (width // 2, int(0.62 * height))
        tip = (width // 2 + side * int(0.16 * width), int(0.42 * height))
        cv2.line(colour, knee, tip, (48, 62, 80), stem // 2)
        cv2.line(alpha, knee, tip, 1.0, stem // 2)


def lamp(rng: np.random.Generator) -> np.ndarray:
    """Cut-out of a street lamp, 4 m."""
    height, width = 4 * GRAIN, 70
    colour, alpha = np.zeros((height, width, 3), np.float32), np.zeros((height, width), np.float32)
    for y, wide in ((50, 9), (height - 70, 16), (height - 14, 24)):
        left = (width - wide) // 2
        colour[y:, left : left + wide] = tinted((62, 68, 60), _rounded(wide, height - y))
        alpha[y:, left : left + wide] = 1
    shade = np.array([[14, 50], [56, 50], [48, 12], [22, 12]])
    cv2.fillConvexPoly(colour, shade, (212, 232, 236), cv2.LINE_AA)
    cv2.fillConvexPoly(alpha, shade, 1.0, cv2.LINE_AA)
    for rim in ((14, 50, 56, 50), (14, 50, 22, 12), (56, 50, 48, 12), (35, 50, 35, 12)):
        cv2.line(colour, rim[:2], rim[2:], (50, 55, 48), 3, cv2.LINE_AA)
    cv2.ellipse(colour, (35, 12), (17, 9), 0, 180, 360, (56, 62, 55), -1, cv2.LINE_AA)
    cv2.ellipse(alpha, (35, 12), (17, 9), 0, 180, 360, 1.0, -1, cv2.LINE_AA)
    return cut_out(colour, alpha)


def bush(rng: np.random.Generator, aspect: float = 1.6) -> np.ndarray:
    """Cut-out of a bush with blossoms, 1 m tall."""
    height, width = GRAIN, int(aspect * GRAIN)
    colour, alpha = np.zeros((height, width, 3), np.float32), np.zeros((height, width), np.float32)
    for _ in range(420):
        angle, far = rng.uniform(0, np.pi), np.sqrt(rng.uniform(0, 1))
        x = width / 2 + np.cos(angle) * far * (width / 2 - 12)
        y = height - 4 - np.sin(angle) * far * (height - 16)
        tone = np.clip(0.98 - 0.5 * y / height - 0.1 * (x / width) + rng.normal(0, 0.12), 0.2, 1.2)
        leaf = (
            np.array([58, 140, 88]) if rng.random() < 0.95 else np.array([150, 120, 235])
        ) * tone
        axes = (int(rng.uniform(3, 8)), int(rng.uniform(2, 5)))
        turn = rng.uniform(0, 180)
        cv2.ellipse(colour, (int(x), int(y)), axes, turn, 0, 360, leaf.tolist(), -1, cv2.LINE_AA)
        cv2.ellipse(alpha, (int(x), int(y)), axes, turn, 0, 360, 1.0, -1, cv2.LINE_AA)
    return cut_out(colour, alpha)


def poster_column(rng: np.random.Generator, width_m: float, tall: float = 2.75) -> np.ndarray:
    """Cut-out of a round column with posters: what hides a figure. Opaque over its width."""
    height, width = int(tall * GRAIN), max(int(width_m * GRAIN), 16)
    light = _rounded(width, height) * (1 + 0.04 * fractal(rng, height, width, 30))
    colour = tinted((128, 140, 138), light)
    around = np.arcsin(np.linspace(-0.999, 0.999, width)) * width / 2  # texels round the column
    top, bottom = int(0.16 * height), int(0.9 * height)
    for row_top, row_bottom in ((top, (top + bottom) // 2 - 3), ((top + bottom) // 2 + 3, bottom)):
        sheets = _posters(rng, row_bottom - row_top, int(np.pi * width / 2) + 2)
        column = (around - around[0]).astype(int)
        colour[row_top:row_bottom] = sheets[:, column] * light[row_top:row_bottom, :, None]
    for begin, end, tone in ((0, 0.1, 0.62), (0.1, 0.13, 0.45), (0.93, 1, 0.5)):
        rows = slice(int(begin * height), int(end * height))
        colour[rows] = tinted((110, 118, 96), light[rows] * tone)
    return cut_out(colour, np.ones((height, width), np.float32))


def _posters(rng: np.random.Generator, height: int, width: int) -> np.ndarray:
    """A strip of posters (height, width, 3) float32."""
    strip = np.full((height, width, 3), 150, np.float32)
    x = 2
    while x < width - 8:
        wide = min(int(rng.uniform(0.55, 0.9) * height), width - x - 2)
        hue = np.uint8([[[rng.integers(180), rng.integers(60, 200), rng.integers(110, 235)]]])
        paper = cv2.cvtColor(hue, cv2.COLOR_HSV2BGR)[0, 0].astype(float)
        sheet = strip[2 : height - 2, x : x + wide]
        sheet[:] = paper
        ink = (255 - paper * 0.8).tolist()
        middle = (wide // 2, int(height * rng.uniform(0.3, 0.5)))
        if rng.random() < 0.5:
            cv2.circle(sheet, middle, max(wide // 4, 2), ink, -1, cv2.LINE_AA)
        else:
            fall = np.linspace(0.55, 1.25, sheet.shape[0])[:, None, None]
            sheet *= fall
            cv2.ellipse(sheet, middle, (wide // 3, wide // 5), 25, 0, 360, ink, -1, cv2.LINE_AA)
        for k in range(4):
            y = int(height * (0.68 + 0.065 * k))
            cv2.line(
                sheet, (5, y), (int(wide * rng.uniform(0.5, 0.9)), y), ink, 3 if k == 0 else 1
            )
        x += wide + 2
    return strip
