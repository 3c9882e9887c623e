# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What every tracker asks of its images and boxes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box


def check_image(image: NDArray[np.uint8], box: Box | None = None) -> None:
    """Raise ValueError unless the image is (H, W, 3) or (H, W) uint8 and shows part of the box."""
    if not isinstance(image, np.ndarray) or image.dtype != np.uint8:
        kind = getattr(image, "dtype", type(image).__name__)
        raise ValueError(f"an image must be a uint8 array, not {kind}: convert it first")
    if image.size == 0 or image.ndim not in (2, 3) or (image.ndim == 3 and image.shape[2] != 3):
        raise ValueError(
            f"an image must be of shape (H, W, 3) in BGR order or (H, W), not {image.shape}"
        )
    height, width = image.shape[:2]
    if box is not None and not box.touches_image(width, height):
        raise ValueError(
            f"the box {box.as_tuple()} lies wholly outside the image of {width} x {height} px: "
            "send x, y, w, h in px of this image"
        )
