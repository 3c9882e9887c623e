# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
import reference

from het_ros.tracking.sub_patches import draw_sub_patches, to_be_updated


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


@pytest.mark.parametrize(
    ("scores", "chosen"),
    [
        ([0, 1, 2, 3, 4], [False, True, True, True, False]),
        ([5, 5, 5, 5, -100], [True, True, True, True, False]),
        ([1, -1], [False, False]),  # both on the open interval's ends
        ([3, 3, 3], [True, True, True]),
        ([7], [True]),
    ],
)
def test_which_to_update(scores, chosen):
    assert to_be_updated(np.array(scores, float)).tolist() == chosen


def test_which_to_update_as_in_the_reference():
    rng = np.random.default_rng(0)
    for scores in rng.normal(size=(50, 11)):
        assert to_be_updated(scores).tolist() == reference.selected(list(scores))
