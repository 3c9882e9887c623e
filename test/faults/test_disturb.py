# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Streams with faults are what their names say, and the same for the same seed."""

from itertools import pairwise

import numpy as np
import pytest

from het_ros.faults.disturb import (
    SECOND,
    delay,
    duplicate,
    freeze,
    lose,
    shift,
    steady,
    swap,
)

GOOD = steady(1000, 30.0)


def rng() -> np.random.Generator:
    return np.random.default_rng(3)


def test_a_good_stream_is_stamped_with_its_times():
    assert [d.frame for d in GOOD] == list(range(1000))
    assert GOOD[30].stamp == 1001 * SECOND and GOOD[30].due == 1.0


@pytest.mark.parametrize("share", [0.0, 0.1, 0.3, 1.0])
def test_shares(share):
    lost = lose(GOOD, share, rng())
    assert lost[0] == GOOD[0] and abs(1 - len(lost) / len(GOOD) - share) < 0.05
    twice = duplicate(GOOD, share, rng())
    assert abs(len(twice) / len(GOOD) - 1 - share) < 0.05
    assert sorted(set(twice), key=lambda d: d.due) == GOOD
    swapped = swap(GOOD, share, rng())
    assert {d.frame for d in swapped} == set(range(1000)) and swapped[0] == GOOD[0]
    moved = sum(a.frame != b.frame for a, b in zip(GOOD, swapped, strict=True)) / 1000
    assert moved <= 2 * share and (moved > share / 2 or not share)
    for stream in (lost, twice, swapped):
        assert all(a.due <= b.due for a, b in pairwise(stream))


def test_late_frames_keep_their_stamps_and_come_in_the_order_of_arrival():
    late = delay(GOOD, 0.2, 0.1, rng())
    assert {(d.frame, d.stamp) for d in late} == {(d.frame, d.stamp) for d in GOOD}
    assert all(a.due <= b.due for a, b in pairwise(late))
    by = [d.due - GOOD[d.frame].due for d in late]
    assert min(by) == 0 and 0.05 < max(by) <= 0.1
    assert any(a.stamp > b.stamp for a, b in pairwise(late))


def test_clocks():
    assert [d.stamp for d in freeze(GOOD, 5, 8)[4:9]] == [GOOD[i].stamp for i in (4, 5, 5, 5, 8)]
    back = shift(GOOD, 10, -5.0)
    assert back[:10] == GOOD[:10] and back[10].stamp == GOOD[10].stamp - 5 * SECOND


def test_the_same_seed_gives_the_same_fault():
    assert lose(GOOD, 0.3, rng()) == lose(GOOD, 0.3, rng())
    assert delay(GOOD, 0.3, 0.2, rng()) == delay(GOOD, 0.3, 0.2, rng())
