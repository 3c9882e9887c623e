# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Noise and patterns that the street's surfaces are made of."""

from __future__ import annotations

import cv2
import numpy as np


def fractal(
    rng: np.random.Generator, height: int, width: int, cell: float, octaves: int = 4
) -> np.ndarray:
    """Fractal noise (height, width) float32, mean 0, deviation 1.

    Args:
        rng: source of the noise.
        height: of the map, px.
        width: of the map, px.
        cell: size of the coarsest grain, px; every octave halves it and its strength.
        octaves: number of grains.
    """
    total = np.zeros((height, width), np.float32)
    for octave in range(octaves):
        size = max(cell / 2**octave, 1.0)
        grid = rng.standard_normal((int(height / size) + 3, int(width / size) + 3))
        grown = cv2.resize(
            grid.astype(np.float32), None, fx=size, fy=size, interpolation=cv2.INTER_CUBIC
        )
        top, left = rng.integers(0, int(size) + 1, 2)
        total += grown[top : top + height, left : left + width] / 2**octave
    return (total - total.mean()) / max(float(total.std()), 1e-6)


def ring_fractal(
    rng: np.random.Generator, height: int, width: int, cell: float, octaves: int = 4
) -> np.ndarray:
    """Fractal noise (height, width) that meets itself at the left and right edge."""
    margin = width // 6
    noise = fractal(rng, height, width + margin, cell, octaves)
    fade = np.linspace(0, 1, margin, dtype=np.float32)
    noise[:, :margin] = noise[:, :margin] * fade + noise[:, width:] * (1 - fade)
    return noise[:, :width]


def tinted(colour: tuple[float, float, float], light: np.ndarray) -> np.ndarray:
    """Picture (h, w, 3) float32 of one BGR colour under a brightness map (h, w)."""
    return np.asarray(colour, np.float32) * light[..., None]


def blocks(
    rng: np.random.Generator,
    height: int,
    width: int,
    block: tuple[int, int],
    joint: int,
    spread: float,
) -> np.ndarray:
    """Brightness map (height, width) float32 of blocks laid in running bond, about 1.

    Args:
        rng: source of the blocks' tints.
        height: of the map, px.
        width: of the map, px.
        block: height and width of one block, px.
        joint: thickness of the dark joints, px.
        spread: deviation of the blocks' brightness.
    """  # fmt: skip
    rows, columns = np.arange(height)[:, None], np.arange(width)[None, :]
    course = rows // block[0]
    shifted = columns + course % 2 * (block[1] // 2)
    tint = rng.normal(1.0, spread, (height // block[0] + 1, width // block[1] + 2))
    light = tint[np.broadcast_to(course, (height, width)), shifted // block[1]]
    in_joint = (rows % block[0] < joint) | (shifted % block[1] < joint)
    bevel = (rows % block[0] < 2 * joint) | (shifted % block[1] < 2 * joint)
    light = np.where(in_joint, 0.62, np.where(bevel, light * 1.05, light))
    return light.astype(np.float32)
