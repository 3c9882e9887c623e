# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a depth image and a box to the target's place in space."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PoseStamped
from numpy.typing import NDArray
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from het_ros.ros.images import ENCODINGS, ImageError, Layout, view
from het_ros.tracking.box import Box

INNER = 0.7  # this much of the box's width and height is looked at: the rest is background
MOST_SAMPLES = 4096
FARTHEST = 1e6  # m: no camera measures that; sums of larger float32 overflow
LEAST_VALID = 0.1  # share of the samples with a depth at all
LEAST_SHARE = 0.15  # share of the valid samples that a surface needs to be the target
GAP = (0.15, 0.04)  # m and share of the depth: a larger step starts another surface


class DepthError(ValueError):
    """No depth of the target; the text says why."""


def metres_of(message: Image) -> NDArray[np.float32]:
    """A depth image as ``(H, W) float32`` m, NaN where there is none.

    Raises:
        ImageError: neither 16UC1 (mm) nor 32FC1 (m), or data too short.
    """
    if message.encoding in ("16UC1", "mono16"):
        pixels = view(message, ENCODINGS["16UC1"])
        scale = 1e-3
    elif message.encoding == "32FC1":
        pixels = view(message, Layout(4, 1))
        scale = 1.0
    else:
        raise ImageError(f"depth is 16UC1 (mm) or 32FC1 (m), not {message.encoding!r}")
    metres = pixels.astype(np.float32) * np.float32(scale)
    return np.where((metres > 0) & (metres < FARTHEST), metres, np.float32(np.nan))


def depth_in(box: Box, size: tuple[int, int], metres: NDArray[np.float32]) -> float:
    """How far away the target in a box is, m along the optical axis.

    The box's inner part holds the target, background beside a thin one, and perhaps a thin thing
    before it. Depths are parted into surfaces at the gaps between them; the target is the nearest
    surface that fills enough of the box, and its median the answer.

    Args:
        box: in an image of ``size`` (width, height) px; the depth image may be of another size,
            if it shows the same view.
        size: see ``box``.
        metres: ``(H, W) float32``, NaN where invalid.

    Raises:
        DepthError: the box lies outside, or there is too little depth in it.
    """
    return nearest_surface(samples_in(box, size, metres))


def samples_in(
    box: Box, size: tuple[int, int], metres: NDArray[np.float32]
) -> NDArray[np.float32]:
    """The depths in the inner part of a box, m, a bounded number of them; see :func:`depth_in`.

    Raises:
        DepthError: the box lies outside, or too few pixels have a depth.
    """
    scale = metres.shape[1] / size[0], metres.shape[0] / size[1]
    inner = Box.from_centre(*box.centre, box.w * INNER, box.h * INNER)
    left, right = (round(edge * scale[0]) for edge in (inner.x, inner.x + inner.w))
    top, bottom = (round(edge * scale[1]) for edge in (inner.y, inner.y + inner.h))
    part = metres[max(top, 0) : max(bottom, top + 1, 0), max(left, 0) : max(right, left + 1, 0)]
    if part.size == 0:
        raise DepthError("the box lies outside the depth image")
    samples = part.ravel()[:: max(part.size // MOST_SAMPLES, 1)]
    valid = samples[np.isfinite(samples)]
    if valid.size < max(LEAST_VALID * samples.size, 1):
        raise DepthError(f"only {valid.size} of {samples.size} pixels in the box have a depth")
    return valid


def nearest_surface(samples: NDArray[np.float32]) -> float:
    """The depth of the nearest surface that holds enough of the samples (n,), m.

    Raises:
        DepthError: there is none.
    """
    for surface in surfaces(samples):
        if surface.size >= max(LEAST_SHARE * samples.size, 1):
            return float(np.median(surface))
    raise DepthError("no surface fills enough of the box: its depths are all over the place")


def surfaces(samples: NDArray[np.float32]) -> list[NDArray[np.float32]]:
    """Depths (n,) in m, parted at the gaps between them, the nearest surface first."""
    depths = np.sort(samples)
    cuts = np.flatnonzero(np.diff(depths) > np.maximum(GAP[0], GAP[1] * depths[:-1])) + 1
    return np.split(depths, cuts)


def pose_at(ray: NDArray[np.float64], depth: float, header: Header) -> PoseStamped:
    """The point on a ray ``depth`` m along the optical axis, orientation left at identity."""
    message = PoseStamped(header=header)
    position = message.pose.position
    position.x, position.y, position.z = map(float, ray / ray[2] * depth)
    return message
