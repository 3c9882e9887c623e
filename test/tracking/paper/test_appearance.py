# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.features.window import Window
from het_ros.tracking.paper.appearance import draw_sub_patches


@pytest.mark.parametrize(
    ("target", "size"),
    [
        ((17, 50), (13, 38)),
        ((40, 20), (30, 15)),
        ((4, 4), (3, 3)),
        ((1, 1), (1, 1)),
        ((0.5, 0.5), (1, 1)),
        ((17.6, 8.2), (13, 6)),
    ],
)
def test_sub_patches_lie_inside_the_target(target, size):
    patches = draw_sub_patches(target, 200, 0.75, np.random.default_rng(0))
    assert patches.size == size
    assert patches.offsets.shape == (200, 2)
    assert (patches.offsets >= 0).all()
    room = np.maximum(np.array(target) - size, 0)
    assert (patches.offsets <= room).all()
    np.testing.assert_array_equal(patches.offsets.max(axis=0), np.floor(room))


def test_re_extraction_keeps_the_layout():
    patches = draw_sub_patches((40, 30), 11, 0.75, np.random.default_rng(0))
    moved = patches.corners(np.array([5.5, -3.0]))
    np.testing.assert_allclose(moved - [5.5, -3.0], patches.offsets)


def test_sub_patches_in_the_image():
    patches = draw_sub_patches((40, 30), 11, 0.75, np.random.default_rng(0))
    window = Window(np.zeros((9, 9), np.uint8), (100.0, -7.0), (1.0, 1.0))
    found = patches.in_image(window, patches.corners(np.array([3.0, 4.0])), np.full(11, 0.4))
    for patch, (x, y) in zip(found, patches.offsets, strict=True):
        assert patch.box.as_tuple() == (103 + x, -3 + y, 30, 22)
        assert patch.weight == 0.4
