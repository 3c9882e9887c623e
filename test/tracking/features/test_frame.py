# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import dataclasses

import numpy as np
import pytest

from het_ros.tracking.features.channels import channel_stack
from het_ros.tracking.features.compressive import (
    CompressiveFeatures,
    draw_measurement_matrix,
    integral_images,
)
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.features.window import cut_window

NAMES = ("b", "lightness", "gradient")


@pytest.fixture
def looks(sequence):
    """Make frames of an image, of one place after another, by one extractor."""
    matrix = draw_measurement_matrix((9, 11), len(NAMES), 20, 4, np.random.default_rng(0))
    features = CompressiveFeatures(matrix, np.float32)

    def look(image, x=60.0, y=50.0):
        window = cut_window(image, x, y, 40, 36)
        channels = channel_stack(window.pixels, NAMES)
        return Frame.of(window, channels, features.maps(integral_images(channels)))

    return sequence("David").image(0), look


def arrays_of(frame):
    return [frame.window.pixels, *frame.channels, frame.stack, frame.features]


def test_nothing_of_a_frame_can_be_written(looks):
    image, look = looks
    frame = look(image)
    for array in arrays_of(frame):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    with pytest.raises(dataclasses.FrozenInstanceError):
        frame.features = None
    assert image.flags.writeable


def test_a_frame_outlives_other_looks_and_its_image(looks):
    """The first look is judged after the second was taken; a camera reuses its memory."""
    image, look = looks
    frame = look(image)
    before = [array.copy() for array in arrays_of(frame)]
    second = look(image, 80.0, 30.0)
    assert not np.array_equal(second.features, frame.features)
    image[...] = 0
    look(image)
    for array, wanted in zip(arrays_of(frame), before, strict=True):
        np.testing.assert_array_equal(array, wanted)
