# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A rendered street that goes round and round: footage for hours, with its truth."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from het_ros.scene.config import SceneConfig
from het_ros.scene.scene import Scene
from het_ros.tracking.box import Box

QUALITY = 95  # of the JPEGs that the loop is kept as
WHOLE = 0.9  # visible part of the target from which on a box of it may start a track


@dataclass(frozen=True)
class Shot:
    """One frame of the loop.

    Attributes:
        jpeg: the image, encoded.
        box: the target, px; None where it is not before the camera.
        visible: the part of it that can be seen, 0..1.
    """

    jpeg: bytes
    box: Box | None
    visible: float

    def pixels(self) -> NDArray[np.uint8]:
        """The image, (H, W, 3) uint8 BGR."""
        pixels = cv2.imdecode(np.frombuffer(self.jpeg, np.uint8), cv2.IMREAD_COLOR)
        assert pixels is not None
        return np.asarray(pixels, np.uint8)

    @property
    def startable(self) -> bool:
        """Whether a track can be started here."""
        return self.box is not None and self.visible >= WHOLE


def render(config: SceneConfig, frames: int = 0, quiet: bool = False) -> list[Shot]:
    """A story, or its first ``frames``, rendered and kept as JPEG.

    ``follow_walk`` has all that a soak needs: a column that hides the target, a passer-by, a
    cloud, near and far. Played in a loop, its end jumps to its beginning.
    """
    scene = Scene(config)
    count = min(frames or len(scene), len(scene))
    shots = []
    for index in tqdm(range(count), "render", unit="frame", disable=quiet, delay=2):
        frame = scene.frame(index)
        encoded, data = cv2.imencode(".jpg", frame.image, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
        assert encoded
        shots.append(Shot(data.tobytes(), frame.box, frame.visible))
    return shots
