# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From the box to space: bearing with camera_info, place with depth. Holds the newest of both."""

from __future__ import annotations

from collections import deque

from geometry_msgs.msg import PoseStamped, Vector3Stamped
from numpy import float32, float64
from numpy.typing import NDArray
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Header

from het_ros.ros.depth import DepthError, metres_of, pose_at
from het_ros.ros.depth_wait import SAME, STRANGE, DepthWait
from het_ros.ros.frames import Frame
from het_ros.ros.hints import Hints
from het_ros.ros.images import ImageError, check_size
from het_ros.ros.messages import stamp_ns
from het_ros.ros.optics import CameraError, bearing_message, ray_of
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.stamps import SECOND
from het_ros.ros.target_depth import TargetDepth
from het_ros.tracking.box import Box

MISSED = 5  # frames in a row without depth: that is no chance
DEPTHS = 8  # depth images that are kept: one of them belongs to the image in work


class Space:
    """Camera model and depth of one camera.

    Attributes:
        wait: how long images wait for depth.
        came: inputs of which there was at least one: "camera_info", "depth".
    """

    def __init__(self, settings: NodeConfig, hints: Hints) -> None:
        self.wait = DepthWait(settings.depth_wait)
        self.came: set[str] = set()
        self.settings = settings
        self._hints = hints
        self._info: CameraInfo | None = None
        self._target = TargetDepth()
        self._missed = 0
        self._depths: deque[Image] = deque(maxlen=DEPTHS)
        self._converted: tuple[Image, NDArray[float32]] | None = None

    @property
    def settings(self) -> NodeConfig:
        """The node's parameters."""
        return self._settings

    @settings.setter
    def settings(self, settings: NodeConfig) -> None:
        self._settings = settings
        self.wait.limit = settings.depth_wait

    def forget(self) -> None:
        """Forget the targets' depths: tracks are counted from 1 again."""
        self._target = TargetDepth()

    def patience(self, frame: Frame) -> float:
        """How much longer a frame is to wait for its depth image, s."""
        left = self.wait.left(stamp_ns(frame.header), frame.arrival)
        if self.wait.in_vain:
            self._hints.once(
                "depth wait",
                f"depth images come later than depth_wait ({self.wait.limit:g} s) after their "
                "images, which are followed without: raise depth_wait. ~/target_pose comes when "
                "the depth does",
            )
        return left

    def on_camera_info(self, message: CameraInfo) -> None:
        """Take the newest calibration."""
        self._info = message
        self.came.add("camera_info")

    def on_depth(self, message: Image) -> None:
        """Keep a depth image, unless it is larger than images may be."""
        self.came.add("depth")
        try:
            # What is kept is the data, whatever size the message claims: 4 bytes make a px.
            check_size(message.width, message.height, self.settings.reading.most)
            check_size(len(message.data) // 4, 1, self.settings.reading.most)
        except ImageError as error:
            self._hints.once("depth size", f"depth image refused: {error}")
            return
        stamp = stamp_ns(message.header)
        if self._depths and stamp < stamp_ns(self._depths[-1].header) - STRANGE * SECOND:
            self._depths.clear()  # time went back
        self._depths.append(message)
        self.wait.depth(stamp)

    def bearing(self, box: Box, size: tuple[int, int], header: Header) -> Vector3Stamped | None:
        """The ray through the box's centre, or None where no usable camera_info came."""
        ray = self._ray(box, size)
        return None if ray is None else bearing_message(ray, header)

    def pose(
        self, box: Box, size: tuple[int, int], header: Header, track: int
    ) -> PoseStamped | None:
        """The place of a track's target, or None without camera_info or depth of the target."""
        depth_image = self._depth_at(header)
        if depth_image is None:
            self._explain_no_depth(header)
            return None
        self._missed = 0
        self._compare_frames(depth_image, header)
        try:
            metres = self._metres(depth_image)
            depth = self._target.measure(box, size, metres, stamp_ns(header), track)
            ray = self._ray(box, size)
            return None if ray is None else pose_at(ray, depth, header)
        except (DepthError, ImageError) as error:
            self._hints.once(f"depth {type(error).__name__}", f"no ~/target_pose: {error}")
            return None

    def seen(self, header: Header) -> bool:
        """Whether depth came of an image, or of a later one: no nearer depth is to come."""
        first = stamp_ns(header) - SAME * SECOND
        return any(stamp_ns(depth.header) >= first for depth in self._depths)

    def may_hold(self, box: Box, size: tuple[int, int], header: Header, track: int) -> bool:
        """Whether a box may hold the track's target; True where there is no depth to tell it."""
        depth_image = self._depth_at(header)
        if depth_image is None or not self.settings.depth_witness:
            return True
        try:
            metres = self._metres(depth_image)
        except ImageError:
            return True
        return self._target.may_be_in(box, size, metres, stamp_ns(header), track)

    def _ray(self, box: Box, size: tuple[int, int]) -> NDArray[float64] | None:
        if self._info is None:
            return None
        try:
            return ray_of(box.centre, self._info, size, self.settings.rectified)
        except CameraError as error:
            self._hints.once("camera", f"no ~/bearing: {error}")
            return None

    def _compare_frames(self, depth_image: Image, header: Header) -> None:
        if depth_image.header.frame_id != header.frame_id:
            self._hints.once(
                "depth frame",
                f"depth is in {depth_image.header.frame_id!r}, the images in {header.frame_id!r}: "
                "send depth that is registered to the images",
            )

    def _metres(self, depth_image: Image) -> NDArray[float32]:
        """A depth image in m, converted once; raises ImageError."""
        if self._converted is None or self._converted[0] is not depth_image:
            self._converted = depth_image, metres_of(depth_image)
        return self._converted[1]

    def _nearest_depth(self, header: Header) -> tuple[Image | None, float]:
        """The depth image nearest in time, and how far off it is, s."""
        stamp = stamp_ns(header)
        offs = [(abs(stamp_ns(image.header) - stamp), i) for i, image in enumerate(self._depths)]
        if not offs:
            return None, 0.0
        off, index = min(offs)
        return self._depths[index], off / SECOND

    def _depth_at(self, header: Header) -> Image | None:
        """The depth image that belongs to an image."""
        nearest, off = self._nearest_depth(header)
        return nearest if off <= self.settings.depth_tolerance else None

    def _explain_no_depth(self, header: Header) -> None:
        nearest, off = self._nearest_depth(header)
        self._missed += 1
        if nearest is not None and self._missed == MISSED:
            self._hints.once(
                "depth stamp",
                f"no ~/target_pose: the nearest depth image is {off:.3f} s off the image, and "
                f"depth_tolerance is {self.settings.depth_tolerance:g} s",
            )
