# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Render a scene into a bag: images, camera_info, the init box and the exact ground truth."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from tqdm import tqdm

from het_ros.scene import STORIES, Frame, Lens, Scene, SceneConfig
from het_ros.tools.arguments import INTERRUPTED, command
from het_ros.tools.bag_messages import (
    CAMERA_INFO,
    COMPRESSED_TOPIC,
    INIT_BOX_TOPIC,
    TRUTH_BOX_TOPIC,
    VISIBILITY_TOPIC,
    box_message,
    compressed_image_message,
    header,
)
from het_ros.tools.bag_writer import TYPESTORE, BagWriter
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.make_bag import FIRST_STAMP, FRAME_ID

CAMERA_INFO_TOPIC = "/camera_info"

EXAMPLE = """examples:
  ros2 run het_ros make_scene_bag bags/follow_walk --seed 11 --rate 15 --quality 36
  ros2 run het_ros make_scene_bag out/hidden --story hidden_2s
"""

_TYPES = TYPESTORE.types


def make_scene_bag(
    scene: Scene, path: Path | str, *, quality: int = 80, stop: StopRequest | None = None
) -> int:
    """Render every frame of a scene into a bag.

    Args:
        scene: what to render.
        path: folder of the bag; it must not exist yet.
        quality: of the JPEG images, 1..100.
        stop: ends the bag early, with what was written until then.

    Returns:
        Number of frames written.

    Raises:
        ValueError: the quality is outside its range.
        FileExistsError: there is something at ``path`` already.
    """
    if not 1 <= quality <= 100:
        raise ValueError(f"{quality} is no JPEG quality: give a number from 1 to 100")
    written = 0
    with BagWriter(path) as bag:
        for frame in tqdm(scene.frames(), "render", len(scene), unit="frame", delay=2):
            if stop:
                break
            _write_frame(bag, frame, scene.lens, quality)
            written += 1
    return written


def _write_frame(bag: BagWriter, frame: Frame, lens: Lens, quality: int) -> None:
    stamp = FIRST_STAMP + round(frame.stamp * 1e9)
    how = [cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_JPEG_OPTIMIZE, 1]
    data = cv2.imencode(".jpg", frame.image, how)[1].tobytes()
    bag.write(COMPRESSED_TOPIC, compressed_image_message(data, stamp, FRAME_ID), stamp)
    bag.write(CAMERA_INFO_TOPIC, camera_info_message(lens, stamp), stamp)
    if frame.box is not None:
        box = box_message(frame.box, stamp, FRAME_ID)
        bag.write(TRUTH_BOX_TOPIC, box, stamp)
        if frame.index == 0:
            bag.write(INIT_BOX_TOPIC, box, stamp)
    bag.write(VISIBILITY_TOPIC, visibility_message(frame.visible, stamp), stamp)


def camera_info_message(lens: Lens, stamp: int) -> Any:
    """sensor_msgs/CameraInfo of a lens without distortion."""
    k = lens.matrix
    roi = _TYPES["sensor_msgs/msg/RegionOfInterest"](
        x_offset=0, y_offset=0, height=0, width=0, do_rectify=False
    )
    return _TYPES[CAMERA_INFO](
        header=header(stamp, FRAME_ID),
        height=lens.height,
        width=lens.width,
        distortion_model="plumb_bob",
        d=np.zeros(5),
        k=k.reshape(-1),
        r=np.eye(3).reshape(-1),
        p=np.hstack([k, np.zeros((3, 1))]).reshape(-1),
        binning_x=0,
        binning_y=0,
        roi=roi,
    )


def visibility_message(visible: float, stamp: int) -> Any:
    """diagnostic_msgs/DiagnosticArray whose one value, "visible", is the part seen, 0..1.

    Of the common interfaces it is the one that carries a stamp and a named number, and the
    tracker's own ~/status speaks it too.
    """
    word = "visible" if visible > 0.98 else "partly hidden" if visible > 0.02 else "hidden"
    value = _TYPES["diagnostic_msgs/msg/KeyValue"](key="visible", value=f"{visible:.4f}")
    status = _TYPES["diagnostic_msgs/msg/DiagnosticStatus"](
        level=0, name="ground truth", message=word, hardware_id="scene", values=[value]
    )
    return _TYPES["diagnostic_msgs/msg/DiagnosticArray"](
        header=header(stamp, FRAME_ID), status=[status]
    )


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = command("make_scene_bag", __doc__, EXAMPLE)
    parser.add_argument("bag", type=Path, help="folder to make")
    parser.add_argument("--story", default="follow_walk", help=f"one of {', '.join(STORIES)}")
    parser.add_argument("--seed", type=int, default=0, help="of everything that is random")
    parser.add_argument("--rate", type=float, default=20.0, help="frames/s (default 20)")
    parser.add_argument("--seconds", type=float, default=0.0, help="default: the story's own")
    parser.add_argument("--size", default="640x480", help="WIDTHxHEIGHT, px (default 640x480)")
    parser.add_argument("--quality", type=int, default=80, help="of the JPEGs (default 80)")
    options = parser.parse_args(argv)
    try:
        width, height = (int(side) for side in options.size.split("x"))
        config = SceneConfig(
            story=options.story,
            seed=options.seed,
            width=width,
            height=height,
            rate=options.rate,
            seconds=options.seconds,
        )
        with StopRequest() as stop:
            frames = make_scene_bag(Scene(config), options.bag, quality=options.quality, stop=stop)
    except (OSError, ValueError) as error:
        print(f"make_scene_bag: {error}", file=sys.stderr)
        return 1
    print(f"{frames} frames in {options.bag}")
    return INTERRUPTED if stop else 0


if __name__ == "__main__":
    sys.exit(main())
