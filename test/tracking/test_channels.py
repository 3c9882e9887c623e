import numpy as np
import pytest

from het_ros.tracking.channels import CHANNEL_NAMES, channel_stack, names_for

RNG = np.random.default_rng(0)
COLOUR = RNG.integers(0, 256, (9, 7, 3), dtype=np.uint8)
GRAY = RNG.integers(0, 256, (9, 7), dtype=np.uint8)


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
    ("names", "image", "wanted"),
    [
        (("b", "g", "r"), COLOUR, ("b", "g", "r")),
        (("b", "g", "r"), GRAY, ("gray",)),
        (("gray",), COLOUR, ("gray",)),
    ],
)
def test_names_for_the_first_image(names, image, wanted):
    assert names_for(names, image) == wanted
