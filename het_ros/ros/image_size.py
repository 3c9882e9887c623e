# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How large a compressed image is by its header: a few bytes can claim more than memory holds."""

from __future__ import annotations

import struct

PNG = b"\x89PNG\r\n\x1a\n"
JPEG = b"\xff\xd8"
TIFF = {b"II*\0": "<", b"MM\0*": ">"}  # byte order by signature
PNG_HEAD = struct.Struct(">8x8xII")  # signature, chunk IHDR: width, height
JPEG_FRAME = struct.Struct(">xHH")  # start of frame: precision, height, width
WITHOUT_LENGTH = {0x01, *range(0xD0, 0xD9)}  # markers TEM, RSTn, SOI
STARTS_OF_FRAME = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}
TIFF_WIDTH, TIFF_HEIGHT, TIFF_SHORT, TIFF_LONG = 256, 257, 3, 4


def claimed_size(data: bytes) -> tuple[int, int] | None:
    """Width and height, px, of a JPEG, PNG or TIFF; None where ``data`` does not tell.

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
    if len(data) < PNG_HEAD.size:
        return None
    width, height = PNG_HEAD.unpack_from(data)
    return int(width), int(height)


def _size_of_jpeg(data: bytes) -> tuple[int, int] | None:
    """Go from marker to marker up to the first start of frame."""
    at = len(JPEG)
    while at + 4 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker == 0xFF:  # a fill byte
            at += 1
        elif marker in WITHOUT_LENGTH:
            at += 2
        elif marker in STARTS_OF_FRAME:
            if at + 4 + JPEG_FRAME.size > len(data):
                return None
            height, width = JPEG_FRAME.unpack_from(data, at + 4)
            return int(width), int(height)
        else:
            at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return None


def _size_of_tiff(data: bytes, order: str) -> tuple[int, int] | None:
    """Width and height among the entries of the first directory."""
    if len(data) < 8:
        return None
    (at,) = struct.unpack_from(f"{order}I", data, 4)
    if at + 2 > len(data):
        return None
    (count,) = struct.unpack_from(f"{order}H", data, at)
    found: dict[int, int] = {}
    for entry in range(at + 2, min(at + 2 + 12 * count, len(data) - 11), 12):
        tag, kind = struct.unpack_from(f"{order}HH", data, entry)
        if tag in (TIFF_WIDTH, TIFF_HEIGHT) and kind in (TIFF_SHORT, TIFF_LONG):
            letter = "H" if kind == TIFF_SHORT else "I"
            (found[tag],) = struct.unpack_from(f"{order}{letter}", data, entry + 8)
    if len(found) < 2:
        return None
    return found[TIFF_WIDTH], found[TIFF_HEIGHT]
