# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from sensor_msgs.msg import Image

from het_ros import Box
from het_ros.ros.depth import DepthError, depth_in, metres_of, pose_at
from het_ros.ros.images import ImageError

from .streams import header_at

SIZE = (160, 120)
BOX = Box(60, 30, 40, 80)
RNG = np.random.default_rng(3)


def wall(distance=6.0) -> np.ndarray:
    return np.full((120, 160), distance, np.float32)


def person(share: float, distance=2.0, behind=6.0) -> np.ndarray:
    """A person who fills the middle ``share`` of the box's width, before a wall."""
    metres = wall(behind)
    half = round(BOX.w * share / 2)
    metres[30:110, 80 - half : 80 + half] = distance
    return metres + RNG.normal(0, 0.01, metres.shape).astype(np.float32)


def slope() -> np.ndarray:
    """A floor that runs away through the box: no gap in it."""
    return np.repeat(np.linspace(5, 2, 120, dtype=np.float32)[:, None], 160, axis=1)


def holes(metres, share) -> np.ndarray:
    metres = metres.copy()
    metres[RNG.random(metres.shape) < share] = np.nan
    return metres


def post(metres, width, distance=0.8) -> np.ndarray:
    """Something narrow that stands before the middle and so far to the right, or left, px."""
    metres = metres.copy()
    metres[:, min(80, 80 + width) : max(80, 80 + width)] = distance
    return metres


@pytest.mark.parametrize(
    "metres, depth",
    [
        (wall(3.0), 3.0),
        (person(1.0), 2.0),
        (person(0.5), 2.0),
        (person(0.2), 2.0),  # thin: most of the box is background
        (person(0.5, 2.0, 2.5), 2.0),  # the wall close behind
        (holes(person(0.5), 0.8), 2.0),
        (post(person(0.6), 2), 2.0),  # a thin thing before the person
        (slope(), 3.25),
    ],
)
def test_depth_of_the_target(metres, depth):
    assert depth_in(BOX, SIZE, metres) == pytest.approx(depth, abs=0.12)


@pytest.mark.parametrize("factor", [2, 0.5])
def test_depth_of_another_size(factor):
    metres = person(0.5)
    scaled = np.kron(metres, np.ones((2, 2))) if factor == 2 else metres[::2, ::2]
    assert depth_in(BOX, SIZE, scaled) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    "metres, box, says",
    [
        (np.full((120, 160), np.nan, np.float32), BOX, "have a depth"),
        (holes(person(0.5), 0.97), BOX, "have a depth"),
        (wall(), Box(500, 500, 20, 20), "outside"),
        (wall(), Box(-50, -50, 20, 20), "outside"),
        (RNG.choice(2.0 ** np.arange(10), (120, 160)), BOX, "all over"),
    ],
)
def test_no_depth_of_the_target(metres, box, says):
    with pytest.raises(DepthError, match=says):
        depth_in(box, SIZE, metres)


@pytest.mark.parametrize(
    "box", [Box(-20, -20, 60, 60), Box(150, 110, 60, 60), Box(3, 3, 0.5, 0.5)]
)
def test_boxes_partly_outside_and_tiny_ones(box):
    assert depth_in(box, SIZE, wall(4.0)) == pytest.approx(4.0)


@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("encoding, kind, scale", [("16UC1", "u2", 1000), ("32FC1", "f4", 1)])
def test_encodings(encoding, kind, scale, big_endian):
    order = ">" if big_endian else "<"
    stored = np.array([[1.5, 0.0], [2.25, 3.0]]) * scale
    if kind == "f4":
        stored[0, 1] = np.inf
    rows = [row.astype(order + kind).tobytes() + b"xy" for row in stored]
    message = Image(
        width=2, height=2, encoding=encoding, step=len(rows[0]), data=b"".join(rows),
        is_bigendian=big_endian,
    )  # fmt: skip
    np.testing.assert_allclose(metres_of(message), [[1.5, np.nan], [2.25, 3.0]], rtol=1e-6)


def test_what_is_farther_than_any_camera_sees_is_no_depth():
    data = wall(2.0**127).tobytes()  # two of them make an infinite sum
    message = Image(width=160, height=120, encoding="32FC1", step=640, data=data)
    with pytest.raises(DepthError, match="have a depth"):
        depth_in(BOX, SIZE, metres_of(message))


def test_other_encodings_are_refused():
    with pytest.raises(ImageError, match="depth is"):
        metres_of(Image(width=1, height=1, encoding="rgb8", step=3, data=bytes(3)))


def test_pose_lies_on_the_ray_at_that_depth():
    message = pose_at(np.array([0.6, 0.0, 0.8]), 4.0, header_at(1.0, "optical"))
    position = message.pose.position
    assert (position.x, position.y, position.z) == pytest.approx((3.0, 0.0, 4.0))
    assert message.header.frame_id == "optical"
    assert message.pose.orientation.w == 1
