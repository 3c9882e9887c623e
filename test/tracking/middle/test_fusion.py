# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The common place and the size, as tables."""

import math

import numpy as np
import pytest

from het_ros.tracking.middle.fusion import followed_size, fused_place

from .proposals import SIZE, proposal


def test_a_common_place_is_nearer_to_the_networks():
    ours, theirs = np.array([10.0, 20.0]), np.array([20.0, 10.0])
    np.testing.assert_allclose(fused_place(ours, theirs), [16, 14])
    np.testing.assert_allclose(fused_place(ours, ours), ours)


@pytest.mark.parametrize(
    ("ratio", "score", "steady", "taken"),
    [
        ((1.0, 1.0), 1.0, 1.0, (0.0, 0.0)),
        ((1.2, 1.2), 0.0, 1.0, (0.0, 0.0)),
        ((1.2, 1.2), 1.0, 1.0, (0.4, 0.4)),  # the area
        ((0.8, 0.8), 1.0, 1.0, (0.4, 0.4)),
        ((1.2, 1 / 1.2), 1.0, 1.0, (0.2, 0.2)),  # the aspect, more slowly
        ((1.2, 1.2), 0.5, 0.8, (0.16, 0.16)),  # by score and steadiness
        ((1.2, 1.0), 1.0, 1.0, (0.3, None)),  # both: half area, half aspect
    ],
)
def test_the_size_follows_a_part_of_the_way(ratio, score, steady, taken):
    found = followed_size(SIZE, proposal(SIZE * ratio, score, steady))
    for side, times, part in zip(found / SIZE, ratio, taken, strict=True):
        if part is not None:
            assert math.log(side) == pytest.approx(part * math.log(times), abs=1e-12)


def test_the_size_arrives_where_the_network_stays():
    size, wanted = SIZE, np.array([35.0, 28.0])
    for _ in range(80):
        size = followed_size(size, proposal(wanted))
    np.testing.assert_allclose(size, wanted, rtol=1e-3)
