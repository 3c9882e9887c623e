# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How large a compressed image is by its header: a few bytes can claim more than memory holds.

What a decoder may read otherwise than it is read here tells no size: a header that says one thing
to this module and another to the decoder would get past every limit.
"""

from __future__ import annotations

import math
import re
import struct

PNG = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"  # signature, and the chunk that has to be the first
PNG_SIZE = struct.Struct(">16xII")  # width, height
JPEG = b"\xff\xd8"
JPEG_MARKER = re.compile(rb"\xff+([\x01\xc0-\xfe])")  # fill bytes, then the marker
JPEG_FRAME = struct.Struct(">3xHH")  # start of frame: length, precision, height, width
WITHOUT_LENGTH = {0x01, *range(0xD0, 0xD9)}  # markers TEM, RSTn, SOI
STARTS_OF_FRAME = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}
MOST_MARKERS = 1000  # before the frame; with Exif, an ICC profile and thumbnails there are dozens
TIFF = {b"II*\0": "<", b"MM\0*": ">"}  # byte order by signature
TIFF_KINDS = {3: "H", 4: "I"}  # SHORT and LONG
IMAGE_WIDTH, IMAGE_LENGTH, TILE_WIDTH, TILE_LENGTH = 256, 257, 322, 323
TIFF_SIDES = {IMAGE_WIDTH, IMAGE_LENGTH, TILE_WIDTH, TILE_LENGTH}


def claimed_size(data: bytes) -> tuple[int, int] | None:
    """Width and height, px, of a JPEG, PNG or TIFF; None where ``data`` does not tell.

    A TIFF whose tiles are larger than the image has their size: they are decoded whole.

    Args:
        data: the image, or its beginning.
    """
    if data.startswith(PNG):
        return _size_of_png(data)
    if data.startswith(JPEG):
        return _size_of_jpeg(data)
    order = TIFF.get(data[:4])
    return _size_of_tiff(data, order) if order else None


def _size_of_png(data: bytes) -> tuple[int, int] | None:
    if len(data) < PNG_SIZE.size:
        return None
    width, height = PNG_SIZE.unpack_from(data)
    return int(width), int(height)


def _size_of_jpeg(data: bytes) -> tuple[int, int] | None:
    """Go from marker to marker up to the first start of frame."""
    at = len(JPEG)
    for _ in range(MOST_MARKERS):
        found = JPEG_MARKER.match(data, at)
        if found is None:
            return None
        marker, at = found[1][0], found.end()
        if marker in STARTS_OF_FRAME:
            if at + JPEG_FRAME.size > len(data):
                return None
            height, width = JPEG_FRAME.unpack_from(data, at)
            return int(width), int(height)
        if marker not in WITHOUT_LENGTH:
            at += int.from_bytes(data[at : at + 2], "big")
    return None


def _size_of_tiff(data: bytes, order: str) -> tuple[int, int] | None:
    """Width and height of image or tile, whichever has more px, by the first directory."""
    if len(data) < 8:
        return None
    (at,) = struct.unpack_from(f"{order}I", data, 4)
    if at + 2 > len(data):
        return None
    (entries,) = struct.unpack_from(f"{order}H", data, at)
    first, end = at + 2, at + 2 + 12 * entries
    if end > len(data):
        return None
    found: dict[int, int] = {}
    for entry in range(first, end, 12):
        tag, kind, count = struct.unpack_from(f"{order}HHI", data, entry)
        if tag not in TIFF_SIDES:
            continue
        if tag in found or kind not in TIFF_KINDS or count != 1:
            return None
        (found[tag],) = struct.unpack_from(f"{order}{TIFF_KINDS[kind]}", data, entry + 8)
    if not {IMAGE_WIDTH, IMAGE_LENGTH} <= found.keys():
        return None
    image = found[IMAGE_WIDTH], found[IMAGE_LENGTH]
    tile = found.get(TILE_WIDTH, 0), found.get(TILE_LENGTH, 0)
    return max(image, tile, key=math.prod)
