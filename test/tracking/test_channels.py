# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.channels import CHANNEL_NAMES, ORIENTATIONS, channel_stack, names_for

RNG = np.random.default_rng(0)
COLOUR = RNG.integers(0, 256, (9, 7, 3), dtype=np.uint8)
GRAY = RNG.integers(0, 256, (9, 7), dtype=np.uint8)
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
