# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import array
import struct

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import CompressedImage, Image

from het_ros.ros.images import ENCODINGS, ImageError, decode, to_array

from .streams import compressed

W, H = 6, 4
RNG = np.random.default_rng(1)
# Slow and obvious: for each pixel the (b, g, r) or gray that its stored channels mean.
COLOURS = {
    "bgr8": lambda c: c,
    "8UC3": lambda c: c,
    "rgb8": lambda c: c[::-1],
    "bgra8": lambda c: c[:3],
    "8UC4": lambda c: c[:3],
    "rgba8": lambda c: c[2::-1],
    "mono8": lambda c: c[0],
    "8UC1": lambda c: c[0],
    "mono16": lambda c: c[0],
    "16UC1": lambda c: c[0],
    "bgr16": lambda c: c,
    "rgb16": lambda c: c[::-1],
    "bgra16": lambda c: c[:3],
    "rgba16": lambda c: c[2::-1],
}
CHANNELS = {"mono": 1, "8UC1": 1, "16UC1": 1, "8UC4": 4, "bgra": 4, "rgba": 4}
ALIASES = {"yuv422": "uyvy", "yuv422_yuy2": "yuyv"}


def channels_of(encoding: str) -> int:
    return next((n for name, n in CHANNELS.items() if encoding.startswith(name)), 3)


def message(encoding, rows, width=W, height=H, padding=0, big_endian=False, kind=bytes) -> Image:
    """An Image of byte rows, each with ``padding`` bytes of rubbish behind it."""
    data = b"".join(bytes(row) + b"\xa5" * padding for row in rows)
    return Image(
        width=width,
        height=height,
        encoding=encoding,
        step=len(rows[0]) + padding,
        is_bigendian=big_endian,
        data=kind(data) if kind is bytes else array.array("B", data),
    )


@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("padding", [0, 1, 7])
@pytest.mark.parametrize("encoding", COLOURS)
def test_interleaved_encodings(encoding, padding, big_endian):
    wide = "16" in encoding
    stored = RNG.integers(0, 65536 if wide else 256, (H, W, channels_of(encoding)))
    order = ">u2" if big_endian else "<u2"
    rows = [row.astype(order if wide else "u1").tobytes() for row in stored]
    pixels = to_array(message(encoding, rows, padding=padding, big_endian=big_endian))

    assert pixels.dtype == np.uint8
    for y in range(H):
        for x in range(W):
            value = np.array(COLOURS[encoding](stored[y, x]), float)
            value = np.rint(value * 255 / 65535) if wide else value
            np.testing.assert_array_equal(pixels[y, x], value)


@pytest.mark.parametrize(
    "white, value, gray",
    [(65535, 65535, 255), (4095, 4095, 255), (4095, 9000, 255), (4095, 2048, 128), (1, 0, 0)],
)
def test_white_level_of_16_bit_images(white, value, gray):
    rows = [np.full(W, value, "<u2").tobytes()] * H
    assert (to_array(message("mono16", rows), white) == gray).all()


# Position of a pattern's letters in each 2 x 2 cell, row by row.
@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_bayer_of_an_even_colour(pattern, bits, big_endian):
    level = {"b": 40, "g": 120, "r": 220}
    scale, order = (1, "u1") if bits == 8 else (257, ">u2" if big_endian else "<u2")
    rows = [
        np.array([level[pattern[2 * (y % 2) + x % 2]] * scale for x in range(8)], order).tobytes()
        for y in range(8)
    ]
    sent = message(f"bayer_{pattern}{bits}", rows, 8, 8, padding=2, big_endian=big_endian)
    assert (to_array(sent) == (40, 120, 220)).all()


def from_yuv(y, u, v) -> np.ndarray:
    """BT.601, 16..235, as (b, g, r)."""
    luma = 1.164 * (y - 16)
    return np.clip(
        [
            luma + 2.018 * (u - 128),
            luma - 0.391 * (u - 128) - 0.813 * (v - 128),
            luma + 1.596 * (v - 128),
        ],
        0,
        255,
    )


@pytest.mark.parametrize("padding", [0, 3])
@pytest.mark.parametrize("encoding", ["uyvy", "yuv422", "yuyv", "yuv422_yuy2"])
def test_yuv422(encoding, padding):
    luma = RNG.integers(16, 236, (H, W))
    u, v = RNG.integers(60, 200, (2, H, W // 2))
    order = ALIASES.get(encoding, encoding)
    rows = []
    for y in range(H):
        row = []
        for x in range(0, W, 2):
            chroma = iter((u[y, x // 2], v[y, x // 2]))
            lumas = iter((luma[y, x], luma[y, x + 1]))
            row += [next(lumas) if letter == "y" else next(chroma) for letter in order]
        rows.append(np.array(row, "u1").tobytes())
    pixels = to_array(message(encoding, rows, padding=padding))
    for y in range(H):
        for x in range(W):
            expected = from_yuv(luma[y, x], u[y, x // 2], v[y, x // 2])
            np.testing.assert_allclose(pixels[y, x], expected, atol=2)


@pytest.mark.parametrize("padding", [0, 2])
@pytest.mark.parametrize("encoding", ["nv12", "nv21"])
def test_yuv420(encoding, padding):
    luma = RNG.integers(16, 236, (H, W))
    u, v = RNG.integers(60, 200, (2, H // 2, W // 2))
    first, second = (u, v) if encoding == "nv12" else (v, u)
    chroma = np.stack([first, second], axis=-1).reshape(H // 2, W)
    rows = [row.astype("u1").tobytes() for row in (*luma, *chroma)]
    pixels = to_array(message(encoding, rows, padding=padding))
    assert pixels.shape == (H, W, 3)
    for y in range(H):
        for x in range(W):
            expected = from_yuv(luma[y, x], u[y // 2, x // 2], v[y // 2, x // 2])
            np.testing.assert_allclose(pixels[y, x], expected, atol=2)


@pytest.mark.parametrize("kind", [bytes, array.array])
@pytest.mark.parametrize("padding", [0, 5])
@pytest.mark.parametrize("encoding", ["bgr8", "8UC3", "mono8", "8UC1"])
def test_plain_layouts_are_not_copied(encoding, padding, kind):
    rows = [RNG.integers(0, 256, W * channels_of(encoding), np.uint8).tobytes()] * H
    sent = message(encoding, rows, padding=padding, kind=kind)
    assert np.shares_memory(to_array(sent), np.frombuffer(sent.data, np.uint8))


@pytest.mark.parametrize(
    "change, says",
    [
        ({"encoding": "jpeg2000"}, "unknown"),
        ({"encoding": "32FC1"}, "unknown"),
        ({"encoding": ""}, "unknown"),
        ({"height": 0}, "nothing in it"),
        ({"width": 0}, "nothing in it"),
        ({"step": W * 3 - 1}, "step"),
        ({"step": 0}, "step"),
        ({"height": H + 1}, "cut off"),
        ({"height": 2**32 - 1}, "cut off"),
        ({"step": 2**32 - 1}, "cut off"),
        ({"data": b""}, "cut off"),
        ({"encoding": "rgba8", "step": W * 4}, "cut off"),
        ({"encoding": "nv12", "width": W, "step": W * 3, "height": H}, "cut off"),
        ({"encoding": "nv12", "width": 3, "step": 3, "height": 2}, "even"),
        ({"encoding": "nv12", "width": 2, "step": 2, "height": 3}, "even"),
        ({"encoding": "yuyv", "width": 3}, "even"),
    ],
)
def test_what_cannot_be_read_is_refused(change, says):
    sent = message("bgr8", [bytes(W * 3)] * H)
    for name, value in change.items():
        setattr(sent, name, value)
    with pytest.raises(ImageError, match=says):
        to_array(sent)


def test_the_last_row_needs_no_padding():
    sent = message("mono8", [bytes(range(W))] * H, padding=4)
    sent.data = sent.data[:-4]
    assert (to_array(sent) == np.arange(W)).all()


@given(
    encoding=st.sampled_from([*ENCODINGS, "", "rgb", "32FC1"]),
    width=st.integers(0, 9) | st.sampled_from([2**16, 2**32 - 1]),
    height=st.integers(0, 9) | st.sampled_from([2**16, 2**32 - 1]),
    step=st.integers(0, 80) | st.sampled_from([2**32 - 1]),
    data=st.binary(max_size=400),
    big_endian=st.booleans(),
)
def test_any_header_over_any_data_gives_pixels_or_an_image_error(
    encoding, width, height, step, data, big_endian
):
    sent = Image(
        encoding=encoding, width=width, height=height, step=step, data=data,
        is_bigendian=big_endian,
    )  # fmt: skip
    try:
        pixels = to_array(sent)
    except ImageError:
        return
    assert pixels.dtype == np.uint8
    assert pixels.shape[:2] == (height, width)


@pytest.mark.parametrize("shape", [(H, W), (H, W, 3)])
def test_png_is_exact(shape):
    pixels = RNG.integers(0, 256, shape, np.uint8)
    np.testing.assert_array_equal(decode(compressed(pixels, "png")), pixels)


@pytest.mark.parametrize("shape", [(64, 48), (64, 48, 3)])
def test_jpeg_is_close(shape):
    pixels = cv2.GaussianBlur(RNG.integers(0, 256, shape, np.uint8), (0, 0), 5)
    got = decode(compressed(pixels, "jpg", "bgr8; jpeg compressed bgr8"))
    assert got.shape == shape
    np.testing.assert_allclose(got.astype(int), pixels, atol=8)


@pytest.mark.parametrize(
    "data, name, says",
    [
        (b"", "jpeg", "no JPEG"),
        (b"no image at all", "jpeg", "no JPEG"),
        (b"\xff\xd8\xff\xe0" + bytes(50), "jpeg", "ends early"),
        (
            cv2.imencode(".jpg", np.zeros((64, 64, 3), np.uint8))[1].tobytes()[:-200],
            "jpeg",
            "early",
        ),
        (bytes(20), "16UC1; compressedDepth", "depth"),
        (
            b"BM" + struct.pack("<8xI", 54) + struct.pack("<IiiHHI20x", 40, 1, 2**25, 1, 8, 0),
            "a BMP of 33554432 rows",
            "no JPEG",
        ),
    ],
)
def test_compressed_data_that_is_no_image_is_refused(data, name, says):
    with pytest.raises(ImageError, match=says):
        decode(CompressedImage(data=data, format=name))


@pytest.mark.parametrize("suffix", ["bmp", "webp", "pgm", "ras"])
def test_formats_that_nobody_sends_are_refused(suffix):
    try:
        message = compressed(np.zeros((8, 8), np.uint8), suffix)
    except cv2.error:
        pytest.skip(f"OpenCV does not write {suffix} here")
    with pytest.raises(ImageError, match="no JPEG, PNG or TIFF"):
        decode(message)
