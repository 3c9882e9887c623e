# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A sequence: its frames, which trackers see, and its ground truth, which they do not."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Frames:
    """The images of a sequence and nothing else: what a job may carry to a tracker.

    Attributes:
        files: the image files in their order.
        rate: frames/s of the camera.
    """

    files: tuple[str, ...]
    rate: float = 30.0

    def __len__(self) -> int:
        return len(self.files)

    def __getitem__(self, index: int) -> NDArray[np.uint8]:
        """Read one image as (H, W, 3) uint8 BGR.

        Raises:
            OSError: the file is missing or is no image.
        """
        image = cv2.imread(self.files[index], cv2.IMREAD_COLOR)
        if image is None:
            raise OSError(f"{self.files[index]} cannot be read as an image")
        return np.asarray(image, np.uint8)

    def taken(self, rows: slice) -> Frames:
        """Some of the frames, in the order of ``rows``, of a camera that gives only these."""
        return Frames(self.files[rows], self.rate / abs(rows.step or 1))

    @property
    def dt(self) -> float:
        """Time between two frames, s."""
        return 1.0 / self.rate

    def fingerprint(self) -> str:
        """Hash of the files' names and sizes and of the rate: same value, same images."""
        listed = "\n".join(f"{Path(f).name} {Path(f).stat().st_size}" for f in self.files)
        return hashlib.sha256(f"{self.rate}\n{listed}".encode()).hexdigest()[:16]


@dataclass(frozen=True)
class Sequence:
    """Frames with their ground truth.

    Attributes:
        name: the sequence's name; a folder with several targets gives NAME-1, NAME-2...
        frames: the images.
        truth: (n, 4) float64 boxes x, y, w, h, px, counted from 0; a row of NaN where the
            target is absent or has no valid box. The first row is always valid.
        attributes: the benchmark's tags, e.g. "OCC".
    """

    name: str
    frames: Frames
    truth: NDArray[np.float64]
    attributes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.frames) != len(self.truth) or len(self.frames) == 0:
            raise ValueError(
                f"{self.name}: {len(self.frames)} frames, but {len(self.truth)} boxes"
            )
        if np.isnan(self.truth[0]).any():
            raise ValueError(f"{self.name}: the first frame needs a valid box to start from")

    @property
    def visible(self) -> NDArray[np.bool_]:
        """(n,) bool: frames in which the target has a valid box."""
        return np.asarray(~np.isnan(self.truth).any(axis=1))
