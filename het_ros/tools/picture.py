# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A short moving picture of a video, for a page: animated WebP, smaller and slower in frames."""

from __future__ import annotations

import argparse
from pathlib import Path

import av
from PIL import Image
from tqdm import tqdm

MOST = 3_000_000  # bytes that a page should carry


def moving_picture(video: Path, path: Path, width: int, rate: float, quality: int) -> int:
    """Write every frame of a video that is due at a rate, scaled, as an animated WebP.

    Args:
        video: what PyAV reads.
        path: WebP to write.
        width: px; the height follows.
        rate: frames/s; more than the video has gives all of them.
        quality: 0..100, WebP's.

    Returns:
        Its size in bytes.

    Raises:
        ValueError: the video has no frames.
    """
    pictures: list[Image.Image] = []
    with av.open(str(video)) as container:
        for frame in tqdm(container.decode(video=0), desc="frames", unit="", leave=False):
            if frame.time is not None and frame.time * rate + 1e-6 >= len(pictures):
                height = round(frame.height * width / frame.width)
                pictures.append(frame.to_image().resize((width, height), Image.Resampling.LANCZOS))
    if not pictures:
        raise ValueError(f"{video} has no frames")
    pictures[0].save(
        path,
        save_all=True,
        append_images=pictures[1:],
        duration=round(1000 / rate),
        loop=0,
        quality=quality,
        method=4,
    )
    return path.stat().st_size


def main(arguments: list[str] | None = None) -> int:
    """Write a picture; 1 where it is too large for a page."""
    parser = argparse.ArgumentParser(
        description="Make a short moving picture of a video.",
        epilog="example: make picture",
    )
    parser.add_argument("video", type=Path)
    parser.add_argument("picture", type=Path, help="WebP to write")
    parser.add_argument("--width", type=int, default=480, help="px")
    parser.add_argument("--rate", type=float, default=7.5, help="frames/s")
    parser.add_argument("--quality", type=int, default=45, help="0..100")
    options = parser.parse_args(arguments)
    size = moving_picture(
        options.video, options.picture, options.width, options.rate, options.quality
    )
    print(f"{options.picture}: {size / 1e6:.2f} MB")
    if size > MOST:
        print(f"more than {MOST / 1e6:g} MB: lower --width, --rate or --quality")
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
