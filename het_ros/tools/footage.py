# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Footage to make bags from: folders of images, annotated or not, and video files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.annotations import image_number
from het_ros.evaluation.readers import read_sequences
from het_ros.tracking.box import Box

IMAGE_SUFFIXES = {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff"}
TRUTH_FILES = "groundtruth*.txt"


@dataclass(frozen=True)
class Footage:
    """Frames in the order of time, and where the target is in them.

    Attributes:
        source: folder of images or video file.
        images: the files of a folder; empty for a video.
        frames: number of frames; of a video the container's own count, which may be off or 0.
        rate: frames/s, None where the source does not say.
        truth: box of each frame, px from 0; None where it has none. Empty without annotation,
            else its first box is valid.
    """

    source: Path
    images: tuple[Path, ...]
    frames: int
    rate: float | None = None
    truth: tuple[Box | None, ...] = ()

    def __iter__(self) -> Iterator[Path | NDArray[np.uint8]]:
        """Image files of a folder, decoded (H, W, 3) BGR frames of a video."""
        return iter(self.images) if self.images else _video_frames(self.source)


def open_footage(source: Path | str) -> Footage:
    """A folder of images, with ground truth if it is there, or a video file.

    Raises:
        FileNotFoundError: nothing is there, or the folder holds no image.
        ValueError: a file that is no video, or a ground truth that cannot be read.
    """
    source = Path(source)
    if not source.exists():
        raise FileNotFoundError(f"{source} does not exist: name a folder of images or a video")
    if source.is_file():
        return _open_video(source)
    if any(source.glob(TRUTH_FILES)):
        return _open_sequence(source)
    return _open_images(source)


def _open_sequence(folder: Path) -> Footage:
    sequence = read_sequences(folder)[0]
    images = tuple(Path(file) for file in sequence.frames.files)
    boxes = tuple(None if np.isnan(row).any() else Box(*row.tolist()) for row in sequence.truth)
    return Footage(folder, images, len(images), sequence.frames.rate, boxes)


def _open_images(folder: Path) -> Footage:
    place = folder / "img" if (folder / "img").is_dir() else folder
    images = [path for path in place.iterdir() if path.suffix.lower() in IMAGE_SUFFIXES]
    if not images:
        raise FileNotFoundError(f"no image (*.jpg, *.png) in {place}")
    images.sort(key=lambda path: (image_number(path), path.name))
    return Footage(folder, tuple(images), len(images))


def _open_video(path: Path) -> Footage:
    capture = cv2.VideoCapture(str(path))
    try:
        if not capture.isOpened():
            raise ValueError(f"{path} is not a video that OpenCV can read")
        rate = capture.get(cv2.CAP_PROP_FPS)
        count = int(capture.get(cv2.CAP_PROP_FRAME_COUNT))
    finally:
        capture.release()
    return Footage(path, (), max(count, 0), rate if 0 < rate < 1000 else None)


def _video_frames(path: Path) -> Iterator[NDArray[np.uint8]]:
    capture = cv2.VideoCapture(str(path))
    try:
        while True:
            read, frame = capture.read()
            if not read:
                return
            yield frame
    finally:
        capture.release()
