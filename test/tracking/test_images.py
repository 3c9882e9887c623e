# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.images import check_image


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (np.zeros((20, 20, 3), np.float32), "uint8 array, not float32"),
        (np.zeros((20, 20, 4), np.uint8), r"\(20, 20, 4\)"),
        (np.zeros((20, 20, 3, 1), np.uint8), "shape"),
        (np.zeros((0, 20), np.uint8), r"\(0, 20\)"),
        ([[1, 2], [3, 4]], "not list"),
        (None, "not NoneType"),
    ],
)
def test_what_is_no_image_is_refused(image, says):
    with pytest.raises(ValueError, match=says):
        check_image(image)


@pytest.mark.parametrize("shape", [(20, 30, 3), (20, 30), (1, 1)])
def test_images_are_gray_or_bgr(shape):
    check_image(np.zeros(shape, np.uint8))


@pytest.mark.parametrize("box", [Box(30, 5, 5, 5), Box(-5, 5, 5, 5), Box(3, 20, 5, 5)], ids=str)
def test_a_box_that_only_touches_the_border_is_outside(box):
    with pytest.raises(ValueError, match="wholly outside the image of 30 x 20 px"):
        check_image(np.zeros((20, 30), np.uint8), box)
    check_image(np.zeros((21, 31), np.uint8), Box(box.x, box.y, box.w + 0.1, box.h))
