# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a figure wears: textures wrapped around the parts of its body.

A texture is (rows, TURN, 3) float32 BGR: rows run from the part's upper joint to its lower one,
columns once around the body, from its front over its left, back and right.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from het_ros.scene.texture import fractal, ring_fractal, tinted

TURN = 128  # columns once around


@dataclass(frozen=True, eq=False)
class Part:
    """One part of the body.

    Attributes:
        texture: (rows, TURN, 3) float32.
        outline: (rows,) half widths, 0..1 of the part's own.
        front, side: width seen from the front and from the side, m.
        over: how far it reaches beyond its two joints, m.
    """

    texture: np.ndarray
    outline: np.ndarray
    front: float
    side: float
    over: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Outfit:
    """A body's height, m, and its parts by name."""

    height: float
    parts: dict[str, Part]


def colour(hue: float, saturation: float, value: float) -> tuple[float, float, float]:
    """BGR of a hue (0..180), saturation and value (0..255)."""
    pixel = np.uint8([[[int(hue) % 180, int(saturation), int(value)]]])
    return tuple(float(c) for c in cv2.cvtColor(pixel, cv2.COLOR_HSV2BGR)[0, 0])


def outfit(rng: np.random.Generator) -> Outfit:
    """Somebody's clothes, drawn at random."""
    height = float(np.clip(rng.normal(1.76, 0.05), 1.62, 1.9))
    skin = np.array([(138, 172, 222), (108, 142, 198), (70, 100, 150)][rng.integers(3)], float)
    hair = np.array([(30, 36, 46), (40, 64, 96), (86, 140, 178), (70, 74, 80)][rng.integers(4)])
    hue = rng.uniform(0, 180)
    jacket = colour(hue, rng.uniform(120, 215), rng.uniform(130, 220))
    second = colour(hue + 90 + rng.uniform(-30, 30), rng.uniform(20, 190), rng.uniform(60, 240))
    denim = colour(rng.choice([108, 112, 18, 0]), rng.uniform(40, 150), rng.uniform(55, 120))
    pack = colour(rng.uniform(0, 180), rng.uniform(90, 200), rng.uniform(60, 150))
    pattern = ("stripes", "panel", "checks")[rng.integers(3)]
    parts = {
        "torso": _torso(rng, jacket, second, pattern),
        "upper_arm": _limb(rng, jacket, 0.118, 0.105, 0.05, (1.0, 0.85), cuff=second),
        "forearm": _limb(rng, jacket, 0.092, 0.086, 0.035, (1.0, 0.72), cuff=second),
        "hand": _limb(rng, tuple(skin), 0.075, 0.085, 0.02, (0.8, 0.7), fold=0.02),
        "thigh": _limb(rng, denim, 0.178, 0.19, 0.07, (1.0, 0.72), seam=True),
        "shank": _limb(rng, denim, 0.132, 0.14, 0.045, (0.98, 0.74), seam=True, bulge=0.1),
        "shoe": _shoe(rng, second),
        "head": _head(rng, skin, hair),
        "throat": _limb(rng, tuple(skin * 0.8), 0.115, 0.125, 0.02, (0.95, 1.0), fold=0.02),
    }
    if rng.random() < 0.6:
        parts["pack"] = _pack(rng, pack)
    return Outfit(height, parts)


def _ends(rows: int, length: float, over: float, width: float) -> np.ndarray:
    """Outline of a tube whose ends are rounded, (rows,)."""
    along = np.linspace(0, length + 2 * over, rows)
    radius = min(width / 2, over * 1.4)
    inset = np.clip(radius - np.minimum(along, along[::-1]), 0, radius)
    return 1 - (1 - np.sqrt(np.clip(1 - (inset / radius) ** 2, 0, 1))) * min(2 * radius / width, 1)


def _folds(rng: np.random.Generator, rows: int, strength: float) -> np.ndarray:
    """Brightness of cloth: creases that run across and grain, (rows, TURN)."""
    creases = ring_fractal(rng, rows * 2, TURN, 26, 3)[::2]
    grain = ring_fractal(rng, rows, TURN, 4, 1)
    return 1 + strength * creases + 0.3 * strength * grain


def _limb(
    rng: np.random.Generator, base: tuple[float, ...], front: float, side: float, over: float,
    taper: tuple[float, float], *, fold: float = 0.09, bulge: float = 0.0, seam: bool = False,
    cuff: tuple[float, ...] | None = None,
) -> Part:  # fmt: skip
    rows = 64
    texture = tinted(base, _folds(rng, rows, fold))
    down = np.linspace(0, 1, rows)
    if cuff is not None:
        band = np.abs(down - 0.5) < 0.07
        texture[band] = texture[band] * 0.25 + np.asarray(cuff) * 0.75
    if seam:
        for column in (TURN // 4, 3 * TURN // 4):
            texture[:, column - 1 : column + 2] *= 0.78
        texture[-3:] *= 0.75
    outline = np.interp(down, [0, 1], taper) + bulge * np.exp(-(((down - 0.3) / 0.2) ** 2))
    return Part(texture, outline * _ends(rows, 0.35, over, front), front, side, (over, over))


def _torso(
    rng: np.random.Generator, jacket: tuple[float, ...], second: tuple[float, ...], pattern: str
) -> Part:
    rows = 110
    down = np.linspace(0, 1, rows)
    texture = tinted(jacket, np.ones((rows, TURN), np.float32))
    if pattern == "stripes":
        band = np.sin(down * 2 * np.pi * 5.5) > 0.35
        texture[band] = second
    elif pattern == "panel":
        texture[(down > 0.24) & (down < 0.45)] = second
        texture[(down > 0.27) & (down < 0.30)] = (236, 238, 240)
    else:
        columns = np.arange(TURN) % 16 < 5
        texture[:, columns] = texture[:, columns] * 0.5 + np.asarray(second) * 0.5
        band = (np.arange(rows) % 20) < 6
        texture[band] = texture[band] * 0.5 + np.asarray(second) * 0.5
    texture[:, [0, 1, TURN - 1]] = np.asarray(jacket) * 0.45  # zip
    texture[: int(0.05 * rows)] = np.asarray(jacket) * 0.7  # collar
    texture[-6:] = np.asarray(jacket) * 0.6  # hem
    texture *= _folds(rng, rows, 0.07)[..., None]
    knots = [0, 0.05, 0.13, 0.24, 0.55, 0.72, 0.93, 1]
    outline = np.interp(down, knots, [0.28, 0.52, 0.9, 1.0, 0.9, 0.86, 0.92, 0.84])
    return Part(texture, outline, 0.42, 0.275, (0.045, 0.13))


def _pack(rng: np.random.Generator, base: tuple[float, ...]) -> Part:
    rows = 64
    texture = tinted(base, _folds(rng, rows, 0.06))
    texture[38:41] *= 0.5
    texture[40:60, TURN // 2 - 22 : TURN // 2 + 22] *= 1.22
    texture[8:11] *= 0.6
    down = np.linspace(-1, 1, rows)
    return Part(texture, (1 - down**6) ** 0.5 * 0.98 + 0.02, 0.30, 0.19, (0.0, 0.0))


def _shoe(rng: np.random.Generator, second: tuple[float, ...]) -> Part:
    rows = 48
    texture = tinted(tuple(0.35 * c + 25 for c in second), _folds(rng, rows, 0.06))
    texture[:, :] *= np.linspace(0.9, 1.1, rows)[:, None, None]
    texture[18:21] = 225
    texture[25:28] = 225
    down = np.linspace(0, 1, rows)
    outline = np.interp(down, [0, 0.12, 0.4, 0.75, 0.93, 1], [0.6, 0.98, 1.0, 0.72, 0.55, 0.2])
    return Part(texture, outline, 0.098, 0.105, (0.035, 0.03))


def _head(rng: np.random.Generator, skin: np.ndarray, hair: np.ndarray) -> Part:
    rows = 80
    down = np.linspace(0, 1, rows)[:, None]
    around = np.abs(np.angle(np.exp(1j * np.arange(TURN) / TURN * 2 * np.pi)))[None, :]
    fringe, nape = rng.uniform(0.2, 0.3), rng.uniform(0.62, 0.95)
    edge = np.interp(around, [0, 0.75, 1.2, 1.75, np.pi], [fringe, fringe, 0.5, nape, nape])
    in_hair = (down < edge)[..., None]
    strands = 1 + 0.2 * fractal(rng, 1, TURN, 5, 2) + 0.08 * ring_fractal(rng, rows, TURN, 9, 3)
    texture = np.where(
        in_hair, tinted(tuple(hair), strands), tinted(tuple(skin), np.ones_like(strands))
    )
    for sign in (1, -1):
        eye = (int(sign * 0.42 / (2 * np.pi) * TURN) % TURN, int(0.46 * rows))
        cv2.ellipse(texture, eye, (3, 2), 0, 0, 360, (235, 238, 240), -1)
        cv2.circle(texture, eye, 1, (40, 34, 30), -1)
        cv2.line(texture, (eye[0] - 3, eye[1] - 5), (eye[0] + 3, eye[1] - 5), hair.tolist(), 1)
        ear = int(sign * 1.5 / (2 * np.pi) * TURN) % TURN
        cv2.ellipse(
            texture, (ear, int(0.53 * rows)), (3, 7), 0, 0, 360, (skin * 0.82).tolist(), -1
        )
        mouth = slice(0, 5) if sign > 0 else slice(TURN - 5, TURN)
        texture[int(0.75 * rows) : int(0.78 * rows), mouth] = skin * (0.62, 0.6, 0.8)
        nose = slice(0, 2) if sign > 0 else slice(TURN - 2, TURN)
        texture[int(0.48 * rows) : int(0.64 * rows), nose] = skin * 1.1
    texture[int(0.84 * rows) :] *= 0.85
    curve = np.linspace(-1, 1, rows)
    outline = np.sqrt(np.clip(1 - np.abs(curve) ** 2.3, 0, 1)) * np.interp(
        curve, [-1, 0.1, 1], [1, 1, 0.82]
    )
    return Part(texture.astype(np.float32), outline, 0.165, 0.205, (0.125, 0.125))
