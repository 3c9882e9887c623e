# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Gaps in a publisher's numbers are images that never came."""

import pytest

from het_ros.ros.losses import Losses


@pytest.mark.parametrize(
    "numbers, publishers, missing",
    [
        ([], 1, 0),
        ([7], 1, 0),  # what was before the first is not ours
        ([1, 2, 3], 1, 0),
        ([1, 3, 6], 1, 3),
        ([9, 10, 1, 2], 1, 0),  # the publisher was started anew
        ([9, 1, 3], 1, 1),
        ([1, 50, 2, 51], 2, 0),  # two publishers' numbers mix
        ([None, None], 1, 0),  # a middleware without numbers
        ([2, 2], 1, 0),
    ],
)
def test_gaps_are_counted(numbers, publishers, missing):
    losses = Losses(lambda: publishers)
    for number in numbers:
        losses.take(number)
    assert losses.count == missing
