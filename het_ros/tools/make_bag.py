# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Turn a folder of images or a video file into a bag that the tracker can be fed with."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from het_ros.tools.arguments import INTERRUPTED, add_init, command
from het_ros.tools.bag_messages import (
    COMPRESSED_TOPIC,
    IMAGE_TOPIC,
    INIT_BOX_TOPIC,
    TRUTH_BOX_TOPIC,
    box_message,
    compressed_image_message,
    image_message,
)
from het_ros.tools.bag_writer import BagWriter
from het_ros.tools.footage import Footage, open_footage
from het_ros.tools.interrupt import StopRequest
from het_ros.tracking.box import Box

FRAME_ID = "camera_optical_frame"
FIRST_STAMP = 10**18  # ns: not zero, which means "no stamp", and the same in every run
DEFAULT_RATE = 30.0
VIDEO_JPEG_QUALITY = 95

EXAMPLE = """examples:
  ros2 run het_ros make_bag sequences/Crossing out/crossing_bag
  ros2 run het_ros make_bag vtest.avi out/vtest_bag --init 258,219,33,89
"""


def make_bag(
    footage: Footage,
    path: Path | str,
    *,
    init: Box | None = None,
    rate: float | None = None,
    raw: bool = False,
    stop: StopRequest | None = None,
) -> int:
    """Write footage as a bag: images, the init box on its image, and ground truth if there is any.

    Args:
        footage: what to write.
        path: folder of the bag; it must not exist yet.
        init: target in the first frame, px; by default the ground truth's.
        rate: frames/s of the stamps; by default the video's own, or 30.
        raw: write sensor_msgs/Image instead of CompressedImage. JPEG and PNG files go into a
            CompressedImage as they are; the frames of a video are encoded as JPEG.
        stop: ends the bag early, with what was written until then.

    Returns:
        Number of frames written.

    Raises:
        ValueError: no init box is known, the rate is not positive, or an image cannot be read.
        FileExistsError: there is something at ``path`` already.
    """
    rate = rate or footage.rate or DEFAULT_RATE
    if not 0 < rate <= 1000:
        raise ValueError(f"{rate:g} frames/s make no sense: give a rate over 0 and up to 1000")
    init = init or (footage.truth[0] if footage.truth else None)
    if init is None:
        raise ValueError(f"no box is known for {footage.source}: give --init x,y,w,h in px")
    frames = -1
    with BagWriter(path, zstd=raw) as bag:
        progress = tqdm(footage, "make_bag", footage.frames or None, unit="frame", delay=2)
        for frames, image in enumerate(progress):
            if stop:
                break
            stamp = FIRST_STAMP + round(frames * 1e9 / rate)
            message = _raw_message(image, stamp) if raw else _compressed_message(image, stamp)
            bag.write(IMAGE_TOPIC if raw else COMPRESSED_TOPIC, message, stamp)
            truth = footage.truth[frames] if footage.truth else None
            if truth:
                bag.write(TRUTH_BOX_TOPIC, box_message(truth, stamp, FRAME_ID), stamp)
            if frames == 0:
                bag.write(INIT_BOX_TOPIC, box_message(init, stamp, FRAME_ID), stamp)
        else:
            frames += 1
    if not frames and not stop:
        raise ValueError(f"{footage.source} has no frame that can be read")
    return frames


def _raw_message(image: Path | NDArray[np.uint8], stamp: int) -> Any:
    return image_message(_decoded(image), stamp, FRAME_ID)


def _compressed_message(image: Path | NDArray[np.uint8], stamp: int) -> Any:
    if isinstance(image, Path) and image.suffix.lower() in {".jpg", ".jpeg", ".png"}:
        kind = "png" if image.suffix.lower() == ".png" else "jpeg"
        return compressed_image_message(image.read_bytes(), stamp, FRAME_ID, kind)
    quality = [cv2.IMWRITE_JPEG_QUALITY, VIDEO_JPEG_QUALITY]
    encoded, data = cv2.imencode(".jpg", _decoded(image), quality)
    if not encoded:
        raise ValueError("a frame could not be encoded as JPEG: try --raw")
    return compressed_image_message(data.tobytes(), stamp, FRAME_ID)


def _decoded(image: Path | NDArray[np.uint8]) -> NDArray[np.uint8]:
    if not isinstance(image, Path):
        return image
    decoded = cv2.imread(str(image), cv2.IMREAD_ANYCOLOR)
    if decoded is None:
        raise ValueError(f"{image} is not an image that OpenCV can read")
    return decoded


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = command("make_bag", __doc__, EXAMPLE)
    parser.add_argument(
        "source", type=Path, help="folder (img/*.jpg, groundtruth_rect.txt), video"
    )
    parser.add_argument("bag", type=Path, help="folder to make")
    add_init(parser)
    parser.add_argument("--rate", type=float, help="frames/s (default: the video's own, or 30)")
    parser.add_argument("--raw", action="store_true", help="Image messages, not CompressedImage")
    options = parser.parse_args(argv)
    try:
        with StopRequest() as stop:
            frames = make_bag(
                open_footage(options.source),
                options.bag,
                init=options.init,
                rate=options.rate,
                raw=options.raw,
                stop=stop,
            )
    except (OSError, ValueError) as error:
        print(f"make_bag: {error}", file=sys.stderr)
        return 1
    print(f"{frames} frames in {options.bag}")
    return INTERRUPTED if stop else 0


if __name__ == "__main__":
    sys.exit(main())
