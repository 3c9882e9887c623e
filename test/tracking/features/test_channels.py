# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import os
import subprocess
import sys

import numpy as np
import pytest

from het_ros.tracking.features.channels import (
    CHANNEL_NAMES,
    ChannelConfig,
    bgr_of,
    channel_stack,
    deviation,
    gray_of,
    is_colourless,
    names_for,
    normalised_gradient,
)

RNG = np.random.default_rng(0)
COLOUR = RNG.integers(0, 256, (9, 7, 3), dtype=np.uint8)
GRAY = RNG.integers(0, 256, (9, 7), dtype=np.uint8)
ORIENTATIONS = ChannelConfig().orientations
ORIENTED = tuple(f"orientation{k}" for k in range(ORIENTATIONS))


def test_colour_planes():
    for plane, wanted in zip(channel_stack(COLOUR, ("r", "b", "g")), (2, 0, 1), strict=True):
        np.testing.assert_array_equal(plane, COLOUR[:, :, wanted])


def test_gray_image_asked_for_colour_gives_gray():
    for plane in channel_stack(GRAY, ("b", "gray", "r")):
        np.testing.assert_array_equal(plane, GRAY)


@pytest.mark.parametrize("pixels", [COLOUR, GRAY], ids=["colour", "gray"])
@pytest.mark.parametrize("name", CHANNEL_NAMES)
def test_every_channel_comes_of_every_image(pixels, name):
    (plane,) = channel_stack(pixels, (name,))
    assert plane.shape == (9, 7)


@pytest.mark.parametrize(
    ("names", "gray", "wanted"),
    [
        (("b", "g", "r"), False, ("b", "g", "r")),
        (("b", "g", "r"), True, ("gray",)),
        (("gray",), False, ("gray",)),
        (("green_red", "blue_yellow"), True, ("texture",)),
        (("green_red", "gradient"), True, ("texture", "gradient")),
        (("blue_yellow",), True, ("gray",)),
    ],
)
def test_names_for_images_with_colour_and_without(names, gray, wanted):
    assert names_for(names, gray) == wanted


def slow_cells(plane, cell):
    rows, columns = plane.shape[0] // cell, plane.shape[1] // cell
    means = np.empty((rows, columns))
    for row in range(rows):
        for column in range(columns):
            part = plane[row * cell : (row + 1) * cell, column * cell : (column + 1) * cell]
            means[row, column] = part.astype(float).mean()
    return means


@pytest.mark.parametrize("cell", [2, 3, 4])
@pytest.mark.parametrize("name", ["b", "gray", "lightness", "green_red"])
def test_channels_are_averaged_over_cells(name, cell):
    """What does not fill a cell at the right and below is left out."""
    (whole,) = channel_stack(COLOUR, (name,))
    (found,) = channel_stack(COLOUR, (name,), cell)
    assert found.dtype == np.uint8
    np.testing.assert_allclose(found, slow_cells(whole, cell), atol=0.51)


@pytest.mark.parametrize("cell", [1, 2])
@pytest.mark.parametrize("pixels", [COLOUR, GRAY], ids=["colour", "gray"])
def test_all_channels_are_bytes_of_one_shape(pixels, cell):
    stack = channel_stack(pixels, CHANNEL_NAMES, cell)
    assert {plane.dtype for plane in stack} == {np.dtype(np.uint8)}
    assert {plane.shape for plane in stack} == {(9 // cell, 7 // cell)}


@pytest.mark.parametrize(
    ("bgr", "channel", "sign"),
    [
        ((40, 40, 220), "green_red", 1),
        ((40, 220, 40), "green_red", -1),
        ((40, 220, 220), "blue_yellow", 1),
        ((220, 40, 40), "blue_yellow", -1),
        ((250, 250, 250), "lightness", 1),
        ((5, 5, 5), "lightness", -1),
    ],
)
def test_lab_channels_are_opponent_colours_about_128(bgr, channel, sign):
    (plane,) = channel_stack(np.full((6, 6, 3), bgr, np.uint8), (channel,))
    assert (sign * (plane.astype(int) - 128) > 20).all()


@pytest.mark.parametrize("value", [0, 77, 255])
def test_gray_pixels_have_no_colour_and_flat_ones_no_gradient(value):
    flat = np.full((12, 12, 3), value, np.uint8)
    a, b, *gradients = channel_stack(flat, ("green_red", "blue_yellow", "gradient", *ORIENTED))
    np.testing.assert_allclose(a, 128, atol=1)
    np.testing.assert_allclose(b, 128, atol=1)
    assert not np.any(gradients)


def wave(degrees, size=48):
    """A gray image whose brightness changes along one direction only."""
    rows, columns = np.mgrid[:size, :size]
    turn = np.radians(degrees)
    along = np.cos(turn) * columns + np.sin(turn) * rows
    return np.rint(128 + 90 * np.sin(along / 3)).astype(np.uint8)


@pytest.mark.parametrize("degrees", [0, 30, 60, 90, 120, 150, 180, 270, 330])
def test_an_edge_goes_into_the_bin_of_its_direction(degrees):
    """A vertical edge, 0 degrees, into the first; light to dark or dark to light is the same."""
    stack = np.array(channel_stack(wave(degrees), ORIENTED))[:, 6:-6, 6:-6]
    shares = stack.sum(axis=(1, 2)) / stack.sum()
    wanted = degrees // (180 // ORIENTATIONS) % ORIENTATIONS
    assert shares.argmax() == wanted
    assert shares[wanted] > 0.75


def test_an_edge_between_two_directions_is_shared():
    stack = np.array(channel_stack(wave(15), ORIENTED), float)[:, 6:-6, 6:-6]
    shares = stack.sum(axis=(1, 2)) / stack.sum()
    np.testing.assert_allclose(shares[:2], 0.5, atol=0.1)


@pytest.mark.parametrize("name", ["David", "Crossing"])
def test_the_bins_of_all_directions_add_up_to_the_gradient(sequence, name):
    frames = sequence(name)
    magnitude, *bins = channel_stack(frames.image(0), ("gradient", *ORIENTED))
    total = np.sum(bins, axis=0, dtype=int)
    unbounded = magnitude < 255
    assert unbounded.mean() > 0.9
    np.testing.assert_allclose(total[unbounded], magnitude[unbounded], atol=ORIENTATIONS / 2)


@pytest.mark.parametrize("factor", [0.4, 0.7])
def test_gradients_say_the_same_in_the_shade(sequence, factor):
    frames = sequence("David")
    box = frames.boxes[0]
    x, y, w, h = (round(v) for v in box.as_tuple())
    face = frames.image(0)[y : y + h, x : x + w]
    face = np.clip(face.astype(float) * 1.6, 0, 255).astype(np.uint8)
    shaded = np.rint(face * factor).astype(np.uint8)
    names = ("gradient", "lightness")
    (bright, lit), (dark, unlit) = (channel_stack(p, names, 2) for p in (face, shaded))
    strong = bright > 60
    ratio = dark[strong].mean() / bright[strong].mean()
    darker = unlit[strong].mean() / lit[strong].mean()
    assert ratio > 0.75  # nearly as strong
    assert darker < ratio


NOISE = np.random.default_rng(0).integers(0, 256, (120, 160), np.uint8)


def tinted(by):
    """Gray noise of which one channel is brighter."""
    image = bgr_of(NOISE // 2)
    image[..., 2] += np.uint8(by)
    return image


@pytest.mark.parametrize(
    ("image", "colourless"),
    [
        (NOISE, True),
        (bgr_of(NOISE), True),
        (tinted(1), True),
        (tinted(3), False),
        (np.zeros((1, 1, 3), np.uint8), True),
        (np.full((1, 3000, 3), (0, 0, 9), np.uint8), False),
    ],
    ids=["one channel", "three alike", "nearly alike", "tinted", "one px", "one row"],
)
def test_what_counts_as_gray(image, colourless):
    assert is_colourless(image, 2.0) is colourless


def test_nothing_of_three_channels_is_gray_below_zero():
    assert not is_colourless(bgr_of(NOISE), 0.0)
    assert is_colourless(NOISE, 0.0)


@pytest.mark.parametrize(
    ("name", "gray"), [("Dog1", True), ("Car1", True), ("Woman", False), ("UAV-person11", False)]
)
def test_real_cameras(sequence, name, gray):
    assert is_colourless(sequence(name).image(0), 2.0) is gray


def test_there_and_back():
    np.testing.assert_array_equal(gray_of(bgr_of(NOISE)), NOISE)
    assert gray_of(NOISE) is NOISE


def test_deviation_is_that_of_the_square_around():
    slow = [
        [NOISE[y - 2 : y + 3, x - 2 : x + 3].astype(float).std() for x in range(2, 158)]
        for y in range(2, 118)
    ]
    np.testing.assert_allclose(deviation(NOISE, 5)[2:-2, 2:-2], slow, rtol=1e-3)
    assert not deviation(np.full((9, 9), 255, np.uint8), 5).any()


@pytest.mark.parametrize("name", ["David", "Crossing", "Bolt2"])
def test_directions_are_those_of_the_arctangent(sequence, name):
    gray = gray_of(sequence(name).image(0))[:101, :67]
    wide = np.pad(gray.astype(float), 1, mode="reflect")
    dx, dy = wide[1:-1, 2:] - wide[1:-1, :-2], wide[2:, 1:-1] - wide[:-2, 1:-1]
    magnitude, directions = normalised_gradient(gray, 2)
    assert ((directions >= 0) & (directions < ORIENTATIONS)).all()
    slow = np.degrees(np.arctan2(dy, dx)) / (180 / ORIENTATIONS)
    away = (directions - slow + ORIENTATIONS / 2) % ORIENTATIONS - ORIENTATIONS / 2
    some = np.hypot(dx, dy) > 0
    assert np.abs(away[some]).max() < 0.02  # 0.6 degrees
    np.testing.assert_array_equal(magnitude > 0, some)


SAME_IN_EVERY_PROCESS = """
import hashlib, random
import numpy as np
from het_ros.tracking.features.channels import CHANNEL_NAMES, channel_stack
from het_ros.tracking.features.window import cut_window
rubbish = [bytearray(random.randrange(1, 9000)) for _ in range(40)]  # memory lies elsewhere
image = np.random.default_rng(0).integers(0, 256, (151, 173, 3), dtype=np.uint8)
digest = hashlib.sha256()
for width, height in ((31, 33), (101, 64), (118, 117), (37, 5)):
    pixels = cut_window(image, 20.3, 11.8, width, height, (0.91, 1.13)).pixels
    for each in (pixels, np.ascontiguousarray(pixels[..., 1])):
        for plane in channel_stack(each, CHANNEL_NAMES, 1) + channel_stack(each, CHANNEL_NAMES, 2):
            digest.update(plane.tobytes())
from het_ros.tracking.features.channels import normalised_gradient
for shape in ((31, 33), (101, 67), (118, 117)):
    for plane in normalised_gradient(np.ascontiguousarray(image[: shape[0], : shape[1], 0]), 2):
        digest.update(plane.tobytes())
print(digest.hexdigest())
"""


def test_every_process_sees_the_same_bits():
    """Also before they are rounded to bytes: in cv2.magnitude the last bits would differ."""
    found = {
        subprocess.run(
            [sys.executable, "-c", SAME_IN_EVERY_PROCESS],
            check=True,
            capture_output=True,
            text=True,
            env={**os.environ, "PYTHONHASHSEED": str(number)},
        ).stdout
        for number in range(6)
    }
    assert len(found) == 1
