# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Image messages to arrays, without cv_bridge (which breaks under NumPy 2).

Every conversion ends in ``(H, W, 3) uint8`` BGR or ``(H, W) uint8`` gray, what the tracker takes.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import CompressedImage, Image

from het_ros.ros.image_size import claimed_size

Pixels = NDArray[np.uint8]
MOST_PIXELS = 50e6
LONGEST_HEADER = 65536  # bytes that are looked at first: some cameras put a thumbnail there
KINDS = {1: np.uint8, 2: np.uint16, 4: np.float32}


class ImageError(ValueError):
    """An image message that cannot be read; the text says what to send instead."""


@dataclass(frozen=True)
class Layout:
    """How one encoding lies in memory.

    Attributes:
        itemsize: bytes a channel: 1 or 2 of a whole number, 4 of a float.
        channels: interleaved channels a pixel; 1 leaves out the last axis.
        colour: cv2 code that turns it into BGR, or None where nothing is to be done.
        plane_rows: rows of data for each two image rows: 2, or 3 where chroma follows below.
    """

    itemsize: int
    channels: int
    colour: int | None = None
    plane_rows: int = 2


ENCODINGS: dict[str, Layout] = {
    "bgr8": Layout(1, 3),
    "8UC3": Layout(1, 3),
    "mono8": Layout(1, 1),
    "8UC1": Layout(1, 1),
    "rgb8": Layout(1, 3, cv2.COLOR_RGB2BGR),
    "bgra8": Layout(1, 4, cv2.COLOR_BGRA2BGR),
    "8UC4": Layout(1, 4, cv2.COLOR_BGRA2BGR),
    "rgba8": Layout(1, 4, cv2.COLOR_RGBA2BGR),
    "mono16": Layout(2, 1),
    "16UC1": Layout(2, 1),
    "bgr16": Layout(2, 3),
    "rgb16": Layout(2, 3, cv2.COLOR_RGB2BGR),
    "bgra16": Layout(2, 4, cv2.COLOR_BGRA2BGR),
    "rgba16": Layout(2, 4, cv2.COLOR_RGBA2BGR),
    "bayer_rggb8": Layout(1, 1, cv2.COLOR_BayerRGGB2BGR),
    "bayer_bggr8": Layout(1, 1, cv2.COLOR_BayerBGGR2BGR),
    "bayer_gbrg8": Layout(1, 1, cv2.COLOR_BayerGBRG2BGR),
    "bayer_grbg8": Layout(1, 1, cv2.COLOR_BayerGRBG2BGR),
    "bayer_rggb16": Layout(2, 1, cv2.COLOR_BayerRGGB2BGR),
    "bayer_bggr16": Layout(2, 1, cv2.COLOR_BayerBGGR2BGR),
    "bayer_gbrg16": Layout(2, 1, cv2.COLOR_BayerGBRG2BGR),
    "bayer_grbg16": Layout(2, 1, cv2.COLOR_BayerGRBG2BGR),
    "yuv422": Layout(1, 2, cv2.COLOR_YUV2BGR_UYVY),
    "uyvy": Layout(1, 2, cv2.COLOR_YUV2BGR_UYVY),
    "yuv422_yuy2": Layout(1, 2, cv2.COLOR_YUV2BGR_YUYV),
    "yuyv": Layout(1, 2, cv2.COLOR_YUV2BGR_YUYV),
    "nv12": Layout(1, 1, cv2.COLOR_YUV2BGR_NV12, plane_rows=3),
    "nv21": Layout(1, 1, cv2.COLOR_YUV2BGR_NV21, plane_rows=3),
}


def to_array(message: Image, white: int = 65535) -> Pixels:
    """The pixels of an Image as ``(H, W, 3) uint8`` BGR or ``(H, W) uint8`` gray.

    bgr8, 8UC3, mono8 and 8UC1 are views of the message's own data, row padding included; the
    array is then read-only where the data is, and lives as long as the message.

    Args:
        message: the image.
        white: value of a 16-bit image that becomes 255; everything above is 255 as well.

    Raises:
        ImageError: unknown encoding, no pixels, a step too short or data too short.
    """
    layout = ENCODINGS.get(message.encoding)
    if layout is None:
        raise ImageError(
            f"the encoding {message.encoding!r} is unknown: send one of {', '.join(ENCODINGS)}"
        )
    pixels = view(message, layout)
    if layout.itemsize == 2:
        pixels = cv2.convertScaleAbs(pixels.astype(np.uint16), alpha=255.0 / white)
    return _to_bgr(pixels, layout, message)


def decode(message: CompressedImage, most: float = MOST_PIXELS) -> Pixels:
    """The pixels of a CompressedImage (JPEG, PNG, TIFF), as :func:`to_array` gives them.

    Args:
        message: the image.
        most: px, more are refused by the header, before anything is decoded.

    Raises:
        ImageError: a depth image, data that is cut off, of another format, or too large.
    """
    if "compressedDepth" in message.format:
        raise ImageError("compressedDepth carries a depth image: send a compressed colour image")
    data = np.frombuffer(message.data, np.uint8)
    if data[:2].tobytes() == b"\xff\xd8" and not _has_jpeg_end(data):
        raise ImageError(f"the JPEG ends early, after {data.size} bytes: is the link losing data?")
    size = claimed_size(data[:LONGEST_HEADER].tobytes()) or claimed_size(data.tobytes())
    if size is None:
        raise ImageError(
            f"{data.size} bytes of format {message.format!r} are no JPEG, PNG or TIFF image"
        )
    check_size(*size, most)
    # The Exif rotation is left alone: boxes are drawn on the sensor's own pixels.
    flags = cv2.IMREAD_ANYCOLOR | cv2.IMREAD_IGNORE_ORIENTATION
    try:
        pixels = cv2.imdecode(data, flags)
    except cv2.error:  # a header that claims more pixels than OpenCV takes
        pixels = None
    if pixels is None:
        raise ImageError(
            f"{data.size} bytes of format {message.format!r} cannot be decoded: the image is "
            "damaged, or of a kind that OpenCV does not read"
        )
    return pixels


@dataclass(frozen=True)
class Reading:
    """How image messages are read.

    Attributes:
        white: value of a 16-bit image that becomes 255; everything above is 255 as well.
        most: px, larger images are refused.
    """

    white: int = 65535
    most: float = MOST_PIXELS


def array_of(message: Image | CompressedImage, reading: Reading | None = None) -> Pixels:
    """The pixels of either kind of image message.

    Raises:
        ImageError: as :func:`decode` and :func:`to_array` do, or the image is too large.
    """
    reading = reading or Reading()
    if isinstance(message, CompressedImage):
        return decode(message, reading.most)
    check_size(message.width, message.height, reading.most)
    return to_array(message, reading.white)


def check_size(width: int, height: int, most: float) -> None:
    """Raise ImageError where an image has more than so many px."""
    if width * height > most:
        raise ImageError(
            f"{width} x {height} px are more than max_megapixels ({most / 1e6:g}): "
            "send smaller images, or raise it"
        )


def _has_jpeg_end(data: Pixels) -> bool:
    """Whether the end marker FF D9 lies in the tail (some cameras pad behind it)."""
    return data[-1024:].tobytes().find(b"\xff\xd9") >= 0


def view(message: Image, layout: Layout) -> NDArray[np.generic]:
    """The data as ``(rows, W[, channels])``, in its own byte order and without a copy.

    Raises:
        ImageError: no pixels, a step too short or data too short.
    """
    height, width, step = message.height, message.width, message.step
    if height == 0 or width == 0:
        raise ImageError(f"the image is {width} x {height} px: there is nothing in it")
    pixel = layout.itemsize * layout.channels
    if step < width * pixel:
        raise ImageError(
            f"step is {step} bytes, but a row of {width} px in {message.encoding} takes "
            f"{width * pixel}: set width, encoding and step as the driver fills the data"
        )
    rows = height * layout.plane_rows // 2
    needed = (rows - 1) * step + width * pixel
    if len(message.data) < needed:
        raise ImageError(
            f"the data is {len(message.data)} bytes, {width} x {height} px in {message.encoding} "
            f"with a step of {step} take {needed}: the image is cut off"
        )
    flat = np.frombuffer(message.data, np.uint8, count=needed)
    shape: tuple[int, ...] = (rows, width)
    strides: tuple[int, ...] = (step, pixel)
    if layout.channels > 1:
        shape, strides = (*shape, layout.channels), (*strides, layout.itemsize)
    kind = np.dtype(KINDS[layout.itemsize]).newbyteorder(">" if message.is_bigendian else "<")
    return np.ndarray(shape, kind, buffer=flat, strides=strides)


def _to_bgr(pixels: NDArray[np.generic], layout: Layout, message: Image) -> Pixels:
    """Apply the layout's colour code, if it has one."""
    if layout.colour is None:
        return pixels
    pairs_columns = layout.channels == 2 or layout.plane_rows == 3
    pairs_rows = layout.plane_rows == 3
    if (pairs_columns and message.width % 2) or (pairs_rows and message.height % 2):
        raise ImageError(
            f"{message.encoding} shares colours between neighbours: "
            f"{message.width} x {message.height} px must be even"
        )
    return cv2.cvtColor(pixels, layout.colour)
