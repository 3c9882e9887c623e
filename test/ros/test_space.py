# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is kept of depth images; what they are good for is in test_depth and test_outputs."""

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import CameraInfo, Image

from het_ros import Box
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.space import Space

from .streams import header_at

HEADER = header_at(1.0)


class Said:
    """Hints, kept in a list."""

    def __init__(self):
        self.texts = []

    def once(self, _, text):
        self.texts.append(text)


def depth_image(width, height, data=None) -> Image:
    plain = np.full((height, width), 2.0, np.float32).tobytes()
    return Image(
        header=HEADER, width=width, height=height, encoding="32FC1", step=4 * width,
        data=plain if data is None else data,
    )  # fmt: skip


def place(depth: Image, said: Said) -> PoseStamped | None:
    """Where a target is by one depth image of up to 0.02 Mpx."""
    space = Space(NodeConfig(max_megapixels=0.02), said)
    info = CameraInfo(width=160, height=120, header=HEADER)
    info.k = [100.0, 0.0, 80.0, 0.0, 100.0, 60.0, 0.0, 0.0, 1.0]
    space.on_camera_info(info)
    space.on_depth(depth)
    return space.pose(Box(60, 40, 20, 30), (160, 120), HEADER, 1)


def test_a_depth_image_as_large_as_images_may_be_is_used():
    said = Said()
    pose = place(depth_image(160, 120), said)
    assert pose is not None and pose.pose.position.z == pytest.approx(2.0)
    assert not said.texts


@pytest.mark.parametrize(
    "depth", [depth_image(160, 130), depth_image(1, 1, bytes(100_000))], ids=["size", "data"]
)
def test_a_larger_one_is_not_kept(depth):
    said = Said()
    assert place(depth, said) is None
    assert "max_megapixels (0.02)" in said.texts[0]
