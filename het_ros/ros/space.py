"""From the box to space: bearing with camera_info, place with depth. Holds the newest of both."""

from __future__ import annotations

from collections import deque

from geometry_msgs.msg import PoseStamped, Vector3Stamped
from numpy import float64
from numpy.typing import NDArray
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Header

from het_ros.ros.depth import DepthError, SteadyDepth, depth_in, metres_of, pose_at
from het_ros.ros.hints import Hints
from het_ros.ros.images import ImageError
from het_ros.ros.messages import stamp_ns
from het_ros.ros.optics import CameraError, bearing_message, ray_of
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.stamps import SECOND
from het_ros.tracking.box import Box

DEPTHS = 5  # depth images that are kept: one of them belongs to the image in work


class Space:
    """Camera model and depth of one camera.

    Attributes:
        settings: the node's parameters.
    """

    def __init__(self, settings: NodeConfig, hints: Hints) -> None:
        self.settings = settings
        self._hints = hints
        self._info: CameraInfo | None = None
        self._steady = SteadyDepth()
        self._depths: deque[Image] = deque(maxlen=DEPTHS)

    def on_camera_info(self, message: CameraInfo) -> None:
        """Take the newest calibration."""
        self._info = message

    def on_depth(self, message: Image) -> None:
        """Keep a depth image."""
        self._depths.append(message)

    def bearing(self, box: Box, size: tuple[int, int], header: Header) -> Vector3Stamped | None:
        """The ray through the box's centre, or None where no usable camera_info came."""
        ray = self._ray(box, size, header)
        return None if ray is None else bearing_message(ray, header)

    def pose(
        self, box: Box, size: tuple[int, int], header: Header, track: int
    ) -> PoseStamped | None:
        """The place of a track's target, or None without camera_info or depth of the target."""
        depth_image = self._depth_at(stamp_ns(header))
        ray = self._ray(box, size, header) if depth_image is not None else None
        if depth_image is None or ray is None:
            return None
        if depth_image.header.frame_id != header.frame_id:
            self._hints.once(
                "depth frame",
                f"depth is in {depth_image.header.frame_id!r}, the images in {header.frame_id!r}: "
                "send depth that is registered to the images",
            )
        try:
            depth = depth_in(box, size, metres_of(depth_image))
            return pose_at(ray, self._steady.checked(depth, stamp_ns(header), track), header)
        except (DepthError, ImageError) as error:
            self._hints.once(f"depth {type(error).__name__}", f"no ~/target_pose: {error}")
            return None

    @property
    def other_thing_for(self) -> float:
        """How long the depth in the box has been another thing's than the target's, s."""
        return self._steady.refused_for

    def _ray(self, box: Box, size: tuple[int, int], header: Header) -> NDArray[float64] | None:
        if self._info is None:
            return None
        try:
            return ray_of(box.centre, self._info, size, self.settings.rectified)
        except CameraError as error:
            self._hints.once("camera", f"no ~/bearing: {error}")
            return None

    def _depth_at(self, stamp: int) -> Image | None:
        nearest = min(
            self._depths, key=lambda depth: abs(stamp_ns(depth.header) - stamp), default=None
        )
        if nearest is None:
            return None
        off = abs(stamp_ns(nearest.header) - stamp) / SECOND
        if off > self.settings.depth_tolerance:
            self._hints.once(
                "depth stamp",
                f"no ~/target_pose: the nearest depth image is {off:.3f} s off the image, and "
                f"depth_tolerance is {self.settings.depth_tolerance:g} s",
            )
            return None
        return nearest
