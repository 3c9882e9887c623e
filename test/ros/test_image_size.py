# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The size is told as decoders read it, or not at all, before anything is decoded."""

import struct
import zlib

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import CompressedImage

from het_ros.ros.image_size import claimed_size
from het_ros.ros.images import ImageError, decode

from .streams import compressed

BYTE, SHORT, LONG, LONG8 = 1, 3, 4, 16  # kinds of values in a TIFF
WIDTH, HEIGHT = (256, LONG, 1, 53), (257, LONG, 1, 37)


def png_chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def bomb_png(side: int) -> bytes:
    """A PNG of so many zeros a side, compressed: a thousandth of its pixels."""
    rows = zlib.compress(bytes(side * (side + 1)), 9)
    header = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    chunks = (png_chunk(b"IHDR", header), png_chunk(b"IDAT", rows), png_chunk(b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def jpeg_of(width: int, height: int, before: bytes = b"") -> bytes:
    """A small JPEG whose header claims another size."""
    data = cv2.imencode(".jpg", np.zeros((8, 8), np.uint8))[1].tobytes()
    frame = data.index(b"\xff\xc0") + 5
    claim = struct.pack(">HH", height, width)
    return data[:2] + before + data[2:frame] + claim + data[frame + 4 :]


def tiff_of(*entries: tuple[int, int, int, int], order: str = "<") -> bytes:
    """The header and directory of a TIFF, of entries (tag, kind, count, value)."""
    listed = b"".join(
        struct.pack(f"{order}HHI{'H2x' if entry[1] == SHORT else 'I'}", *entry)
        for entry in entries
    )
    signature = {"<": b"II*\0", ">": b"MM\0*"}[order]
    count = struct.pack(f"{order}IH", 8, len(entries))
    return signature + count + listed + bytes(4)


def segment(marker: int, data: bytes) -> bytes:
    return bytes((0xFF, marker)) + struct.pack(">H", len(data) + 2) + data


THUMBNAIL = cv2.imencode(".jpg", np.zeros((16, 16), np.uint8))[1].tobytes()
EXIF = segment(0xE1, THUMBNAIL)
COMMENT = segment(0xFE, b"")
PNG = compressed(np.zeros((37, 53), np.uint8), "png").data.tobytes()


@pytest.mark.parametrize(
    "data",
    [
        bomb_png(8000),
        jpeg_of(65000, 65000),
        jpeg_of(65000, 65000, EXIF),  # the thumbnail's own header is a small one
        tiff_of((256, LONG, 1, 60000), (257, LONG, 1, 60000)),
        tiff_of(WIDTH, HEIGHT, (322, LONG, 1, 16000), (323, LONG, 1, 16000)),
    ],
    ids=["png", "jpeg", "jpeg with a thumbnail", "tiff", "tiff in one large tile"],
)
def test_a_bomb_is_refused_by_its_header(data, monkeypatch):
    def never(*_):
        raise AssertionError("it was decoded")

    monkeypatch.setattr(cv2, "imdecode", never)
    with pytest.raises(ImageError, match="max_megapixels"):
        decode(CompressedImage(data=data, format="jpeg"))


@pytest.mark.parametrize("suffix", ["jpg", "png", "tiff"])
@pytest.mark.parametrize("shape", [(37, 53), (37, 53, 3), (1, 1)])
def test_the_size_in_the_header(suffix, shape):
    sent = compressed(np.zeros(shape, np.uint8), suffix)
    assert claimed_size(bytes(sent.data)) == shape[1::-1]
    assert decode(sent, most=shape[0] * shape[1]).shape == shape
    if shape != (1, 1):
        with pytest.raises(ImageError, match="max_megapixels"):
            decode(sent, most=shape[0] * shape[1] - 1)


@pytest.mark.parametrize("quality", [cv2.IMWRITE_JPEG_PROGRESSIVE, cv2.IMWRITE_JPEG_RST_INTERVAL])
def test_other_kinds_of_jpeg(quality):
    pixels = np.zeros((37, 53, 3), np.uint8)
    assert claimed_size(cv2.imencode(".jpg", pixels, [quality, 1])[1].tobytes()) == (53, 37)


@pytest.mark.parametrize("suffix", ["jpg", "png", "tiff"])
def test_a_header_that_is_cut_off_anywhere_gives_no_size_or_the_right_one(suffix):
    data = bytes(compressed(np.zeros((37, 53), np.uint8), suffix).data)
    for length in range(min(len(data), 700)):
        assert claimed_size(data[:length]) in (None, (53, 37))


@pytest.mark.parametrize(
    "data",
    [
        jpeg_of(53, 37, b"\xff" * 100_000),
        jpeg_of(53, 37, EXIF * 255),
        jpeg_of(53, 37, b"\xff\x01" + COMMENT),
        tiff_of((256, SHORT, 1, 53), (257, SHORT, 1, 37), order=">"),
        tiff_of(WIDTH, HEIGHT, (322, SHORT, 1, 16), (323, SHORT, 1, 16)),
    ],
    ids=["fill bytes", "many segments", "TEM", "big-endian shorts", "small tiles"],
)
def test_rare_headers(data):
    assert claimed_size(data) == (53, 37)


@pytest.mark.parametrize(
    "data",
    [
        # libjpeg goes on behind FF 00, and finds what is hidden there.
        jpeg_of(8, 8, segment(0x00, jpeg_of(53, 37)[2:])),
        jpeg_of(53, 37, b"\xff\xfe\x00\x00"),
        jpeg_of(53, 37, b"\xff\xfe\x00\x01"),
        jpeg_of(53, 37, b"\x00" * 8),
        jpeg_of(53, 37, COMMENT * 100_000),
        # OpenCV 4.6 takes the IHDR behind it.
        PNG[:8] + png_chunk(b"aaAa", struct.pack(">II", 8, 8)) + PNG[8:],
        # libtiff takes the first of two, and numbers of every kind.
        tiff_of(WIDTH, HEIGHT, (256, LONG, 1, 8), (257, LONG, 1, 8)),
        tiff_of((256, LONG8, 1, 8), (256, LONG, 1, 8), HEIGHT),
        tiff_of((256, BYTE, 1, 53), HEIGHT),
        tiff_of((256, LONG, 2, 53), HEIGHT),
        tiff_of(WIDTH, HEIGHT, (322, LONG8, 1, 8), (323, LONG, 1, 8)),
        tiff_of(WIDTH),
        tiff_of(WIDTH, HEIGHT, (258, SHORT, 1, 8))[:-8],
    ],
    ids=[
        "stuffing",
        "a segment without a length",
        "a length within itself",
        "zeros between segments",
        "endless segments",
        "a chunk before IHDR",
        "two widths",
        "64 bits before 32",
        "a byte",
        "two values",
        "a tile of 64 bits",
        "no height",
        "a directory that is cut off",
    ],
)
def test_headers_that_decoders_may_read_otherwise_tell_no_size(data):
    assert claimed_size(data) is None


@given(st.sampled_from([PNG[:8], PNG[:16], b"\xff\xd8", b"II*\0", b"MM\0*"]), st.binary())
def test_any_bytes_behind_a_signature_are_a_size_or_none(signature, data):
    size = claimed_size(signature + data)
    assert size is None or min(size) >= 0


def test_a_directory_elsewhere_tells_no_size():
    data = tiff_of(WIDTH, HEIGHT)
    for at in range(len(data) + 2):
        moved = data[:4] + struct.pack("<I", at) + data[8:]
        assert claimed_size(moved) == ((53, 37) if at == 8 else None)
