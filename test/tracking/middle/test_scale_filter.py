# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.features.channels import channel_stack
from het_ros.tracking.features.frame import stacked
from het_ros.tracking.features.window import cut_window
from het_ros.tracking.middle.scale_filter import ScaleFilter

RNG = np.random.default_rng(4)
STACK = stacked(tuple(RNG.integers(0, 256, (30, 40), np.uint8) for _ in range(3)))
CHANNELS = ("lightness", "green_red", "blue_yellow", "gradient")


def test_channels_are_left_as_they_are():
    before = STACK.copy()
    scale = ScaleFilter((12, 16), 0.1, 0.0)
    scale.learn(STACK, np.array([20.0, 15.0]), 1.0, 1.0)
    scale.change(STACK, np.array([20.0, 15.0]))
    np.testing.assert_array_equal(STACK, before)


def stack_of(image, box, zoom, side=48):
    """The window around a box, in which the target appears ``zoom`` times as large."""
    scale = zoom * side / np.sqrt(box.area)
    half = 1.1 * side * np.array([box.w, box.h]) / np.sqrt(box.area)
    width, height = np.ceil(2 * half).astype(int)
    x, y = np.array(box.centre) - half / scale
    window = cut_window(image, x, y, int(width), int(height), (scale, scale))
    return stacked(channel_stack(window.pixels, CHANNELS, 2)), half / 2


@pytest.mark.parametrize("zoom", [0.94, 0.96, 0.98, 1.0, 1.02, 1.04, 1.06])
@pytest.mark.parametrize("name", ["David", "Crossing", "Couple", "Car1"])
def test_a_known_zoom_of_a_real_frame_is_found(sequence, name, zoom):
    """At once the filter goes part of the way, in a few frames all of it to within a step."""
    frames = sequence(name)
    image, box = frames.image(0), frames.boxes[0]
    size = 24 * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = ScaleFilter((round(size[0]), round(size[1])), 0.02, 0.0)
    stack, centre = stack_of(image, box, 1.0)
    scale.learn(stack, centre, 1.0, 1.0)
    growth, ratios = 1.0, []
    for _ in range(6):
        stack, centre = stack_of(image, box, zoom / growth)
        ratios.append(scale.change(stack, centre))
        growth *= ratios[-1]
    assert growth == pytest.approx(zoom, abs=0.02)
    least, most = sorted((1.0, zoom))
    assert least - 0.005 <= ratios[0] <= most + 0.005


def test_a_target_that_grows_and_shrinks_is_followed(sequence):
    """The filter learns at the size it found, as the tracker has it do, and does not drift."""
    frames = sequence("David")
    image, box = frames.image(0), frames.boxes[0]
    size = 24 * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = ScaleFilter((round(size[0]), round(size[1])), 0.1, 0.0)
    stack, centre = stack_of(image, box, 1.0)
    scale.learn(stack, centre, 1.0, 1.0)
    growth = 1.0
    for zoom in [*np.linspace(1, 1.3, 15), *np.linspace(1.3, 0.9, 20)]:
        stack, centre = stack_of(image, box, zoom / growth)
        ratio = scale.change(stack, centre)
        scale.learn(stack, centre, ratio, 1.0)
        growth *= ratio
        assert growth == pytest.approx(zoom, rel=0.06)


def test_nothing_to_see_keeps_the_size():
    flat = np.full((30, 1, 40), 77, np.float32)
    scale = ScaleFilter((12, 16), 0.1, 0.0)
    scale.learn(flat, np.array([20.0, 15.0]), 1.0, 1.0)
    ratio = scale.change(flat, np.array([20.0, 15.0]))
    assert 1.02**-8 <= ratio <= 1.02**8  # whatever it is, no farther than it looked


@pytest.mark.parametrize(("share", "kept"), [(0.0, False), (0.5, True)])
def test_the_first_frame_is_kept(sequence, share, kept):
    """After hundreds of frames of something else the first frame's size is known or forgotten."""
    frames = sequence("David")
    image, box = frames.image(0), frames.boxes[0]
    size = 24 * np.array([box.w, box.h]) / np.sqrt(box.area)
    scale = ScaleFilter((round(size[0]), round(size[1])), 0.05, share)
    stack, centre = stack_of(image, box, 1.0)
    larger, _ = stack_of(image, box, 1.06)
    scale.learn(stack, centre, 1.0, 1.0)
    for _ in range(200):  # the same target at another size, taken for the present one
        scale.learn(larger, centre, 1.0, 1.0)
    off = abs(scale.change(larger, centre) - 1)
    assert (off > 0.005) is kept
