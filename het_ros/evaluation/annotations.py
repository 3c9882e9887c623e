# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lines of ground truth: boxes, polygons, masks and absent targets as one array of boxes."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_SEPARATORS = re.compile(r"[,;\s]+")
ABSENT = (np.nan,) * 4


def read_boxes(file: Path, first_pixel: int) -> NDArray[np.float64]:
    """Read one region a line as boxes counted from 0.

    Numbers are separated by commas, tabs or blanks; CR line ends and empty lines at the end are
    accepted. Four numbers are x, y, w, h; eight or more are a polygon's corners x1, y1, x2, y2...
    of which the bounds are taken; a line with ``m`` in front is a VOT mask, whose first four
    numbers are its bounds. NaN, or a side that is not positive, means: no valid box.

    Args:
        file: the text file.
        first_pixel: what the file calls the top-left pixel: 1 in OTB, 0 in VOT.

    Returns:
        (n, 4) float64 x, y, w, h, px; rows of NaN where there is no valid box.

    Raises:
        ValueError: a line is none of these; it names the file and the line.
    """
    lines = file.read_text(encoding="utf-8-sig").splitlines()
    while lines and not lines[-1].strip():
        lines.pop()
    if not lines:
        raise ValueError(f"{file} is empty: one box a line is needed")
    rows = []
    for number, line in enumerate(lines, start=1):
        try:
            rows.append(_parse(line))
        except ValueError as error:
            raise ValueError(f"{file}, line {number}: {error}") from None
    return np.array(rows, np.float64) - (first_pixel, first_pixel, 0, 0)


def _parse(line: str) -> tuple[float, ...]:
    text = line.strip()
    mask = text.startswith("m")
    words = [word for word in _SEPARATORS.split(text.lstrip("m")) if word]
    if mask:
        words = words[:4]
    values = np.array([float(word) for word in words])
    if len(values) != 4 and (len(values) < 6 or len(values) % 2):
        raise ValueError(f"4 numbers, or a polygon's corners, are needed, not {line.strip()!r}")
    if not np.isfinite(values).all():
        return ABSENT
    if len(values) > 4:
        corners = values.reshape(-1, 2)
        values = np.concatenate([corners.min(axis=0), np.ptp(corners, axis=0)])
    return tuple(values) if values[2] > 0 and values[3] > 0 else ABSENT


# Parts of OTB's sequences that the benchmark uses: first and last image by the number in its
# name. Everywhere else all images count. From the benchmark's list of sequences.
OTB_RANGES = {
    "BlurCar1": (247, 988),
    "BlurCar3": (3, 359),
    "BlurCar4": (18, 397),
    "David": (300, 770),
    "Diving": (1, 215),
    "Football1": (1, 74),
    "Freeman3": (1, 460),
    "Freeman4": (1, 283),
    "Tiger1": (6, 354),
}


def align(
    name: str, files: list[Path], truth: NDArray[np.float64]
) -> tuple[list[Path], NDArray[np.float64]]:
    """Match images with boxes where a sequence has more of one than of the other.

    OTB's annotated range decides for its own sequences. Elsewhere the first image belongs to the
    first box and what is left over at the end is dropped, with a warning.

    Returns:
        As many files as boxes, starting at the first valid box.
    """
    if len(files) != len(truth) and name in OTB_RANGES:
        first, last = OTB_RANGES[name]
        files = [file for file in files if first <= image_number(file) <= last]
        truth = truth[len(truth) - len(files) :] if len(truth) > len(files) else truth
    if len(files) != len(truth):
        n = min(len(files), len(truth))
        warnings.warn(
            f"{name}: {len(files)} images, but {len(truth)} boxes; the first {n} are used",
            stacklevel=2,
        )
        files, truth = files[:n], truth[:n]
    valid = ~np.isnan(truth).any(axis=1)
    if not valid.any():
        raise ValueError(f"{name}: no frame has a valid box")
    first = int(np.argmax(valid))
    return files[first:], truth[first:]


def image_number(file: Path) -> int:
    """The number in an image's name: 300 for 0300.jpg; -1 when there is none."""
    digits = re.findall(r"\d+", file.stem)
    return int(digits[-1]) if digits else -1
