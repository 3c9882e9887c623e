"""From a depth image and a box to the target's place in space."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PoseStamped
from numpy.typing import NDArray
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from het_ros.ros.images import ENCODINGS, ImageError, Layout, view
from het_ros.ros.stamps import SECOND
from het_ros.tracking.box import Box

INNER = 0.7  # this much of the box's width and height is looked at: the rest is background
MOST_SAMPLES = 4096
FARTHEST = 1e6  # m: no camera measures that; sums of larger float32 overflow
LEAST_VALID = 0.1  # share of the samples with a depth at all
LEAST_SHARE = 0.15  # share of the valid samples that a surface needs to be the target
GAP = (0.15, 0.04)  # m and share of the depth: a larger step starts another surface
SLACK = 0.5  # m: so much the depth of a body varies from frame to frame
FASTEST = 4.0  # m/s between camera and target, while nothing is looked at
HIDDEN = 0.8  # m/s, while something else is seen in the target's place
BLINK = 0.5  # s: over a longer time without a look, anything within FASTEST may have happened


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
    samples = _samples(box, size, metres)
    valid = np.sort(samples[np.isfinite(samples)])
    if valid.size < max(LEAST_VALID * samples.size, 1):
        raise DepthError(f"only {valid.size} of {samples.size} pixels in the box have a depth")
    steps = np.diff(valid)
    cuts = np.flatnonzero(steps > np.maximum(GAP[0], GAP[1] * valid[:-1])) + 1
    for surface in np.split(valid, cuts):
        if surface.size >= LEAST_SHARE * valid.size:
            return float(np.median(surface))
    raise DepthError("no surface fills enough of the box: its depths are all over the place")


class SteadyDepth:
    """Tells the target's depth from that of something else which the box has come to hold.

    A body's depth changes little from frame to frame. After a step the old depth is what is
    believed in, and it may only have drifted as far as somebody walks behind what hides them.
    """

    def __init__(self) -> None:
        self._depth = 0.0
        self._stamp = 0
        self._looked = 0
        self._track = -1

    @property
    def refused_for(self) -> float:
        """How long the box has held something else, s; 0 while it holds the target."""
        return (self._looked - self._stamp) / SECOND

    def checked(self, depth: float, stamp: int, track: int) -> float:
        """The depth (m) at a stamp (ns) of a track, if it follows from those before.

        Raises:
            DepthError: it is another thing's.
        """
        passed = max(stamp - self._stamp, 0) / SECOND
        watched = (stamp - self._looked) / SECOND < BLINK
        allowed = SLACK + passed * (HIDDEN if watched else FASTEST)
        self._looked = stamp
        if track == self._track and abs(depth - self._depth) > allowed:
            raise DepthError(
                f"the depth went from {self._depth:.1f} to {depth:.1f} m in {passed:.2f} s: "
                "that is another thing in the box"
            )
        self._depth, self._stamp, self._track = depth, stamp, track
        return depth


def pose_at(ray: NDArray[np.float64], depth: float, header: Header) -> PoseStamped:
    """The point on a ray ``depth`` m along the optical axis, orientation left at identity."""
    message = PoseStamped(header=header)
    position = message.pose.position
    position.x, position.y, position.z = map(float, ray / ray[2] * depth)
    return message


def _samples(box: Box, size: tuple[int, int], metres: NDArray[np.float32]) -> NDArray[np.float32]:
    """The depth pixels of the box's inner part, thinned out to a bounded number."""
    scale = metres.shape[1] / size[0], metres.shape[0] / size[1]
    inner = Box.from_centre(*box.centre, box.w * INNER, box.h * INNER)
    left, right = (round(edge * scale[0]) for edge in (inner.x, inner.x + inner.w))
    top, bottom = (round(edge * scale[1]) for edge in (inner.y, inner.y + inner.h))
    part = metres[max(top, 0) : max(bottom, top + 1, 0), max(left, 0) : max(right, left + 1, 0)]
    if part.size == 0:
        raise DepthError("the box lies outside the depth image")
    return part.ravel()[:: max(part.size // MOST_SAMPLES, 1)]
