# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether a box holds the target by its depth."""

import pytest

from het_ros.ros.depth import DepthError
from het_ros.ros.stamps import SECOND
from het_ros.ros.target_depth import TargetDepth

from .test_depth import BOX, SIZE, holes, person, post, wall

FIRST = person(0.5, 2.0)


def known() -> TargetDepth:
    """Track 1, a person two metres away at 0 s."""
    target = TargetDepth()
    assert target.measure(BOX, SIZE, FIRST, 0, 1) == pytest.approx(2.0, abs=0.1)
    return target


@pytest.mark.parametrize(
    "track, seconds, metres, depth",
    [
        (1, 0.1, person(0.5, 2.4), 2.4),
        (1, 0.1, person(0.5, 1.6), 1.6),
        (1, 0.1, person(0.3, 2.0), 2.0),  # turned sideways
        (1, 1.0, person(0.5, 5.5, 9.0), 5.5),  # not looked at for a second: somebody ran
        (1, 0.1, post(person(0.5), 6), 2.0),  # a lamp post before, a little of it
        (1, 0.1, post(person(0.5), 12, 1.6), 2.0),  # somebody close before, a shoulder of them
        (1, 0.1, holes(person(0.5), 0.8), 2.0),
        (1, 0.1, person(0.5, 6.0, 9.0), None),  # on somebody behind
        (1, 0.1, wall(6.0), None),  # on the wall behind
        (1, 0.1, wall(0.8), None),  # a column before
        (1, 0.1, post(post(person(0.5), 20), -7), None),  # it covers more than half of the person
        (2, 0.1, wall(6.0), 6.0),  # another target
        (1, 5.0, wall(6.0), 6.0),  # long enough for anything
    ],
)
def test_a_box_that_holds_the_target_and_one_that_holds_something_else(
    track, seconds, metres, depth
):
    target, stamp = known(), round(seconds * SECOND)
    assert target.may_be_in(BOX, SIZE, metres, stamp, track) == (depth is not None)
    target = known()
    if depth is None:
        with pytest.raises(DepthError, match="another thing"):
            target.measure(BOX, SIZE, metres, stamp, track)
        assert target.measure(BOX, SIZE, FIRST, stamp, track) == pytest.approx(2.0, abs=0.1)
    else:
        assert target.measure(BOX, SIZE, metres, stamp, track) == pytest.approx(depth, abs=0.15)


@pytest.mark.parametrize("metres", [wall(float("nan")), holes(wall(), 0.99)])
def test_where_there_is_no_depth_it_says_nothing(metres):
    target = known()
    assert target.may_be_in(BOX, SIZE, metres, SECOND // 10, 1)
    with pytest.raises(DepthError, match="have a depth"):
        target.measure(BOX, SIZE, metres, SECOND // 10, 1)


def test_nothing_is_known_of_another_track():
    assert known().may_be_in(BOX, SIZE, wall(9.0), SECOND // 10, 2)


def test_a_column_is_a_column_however_long_it_hides_the_target():
    """The longer it is away the farther the target may have come, but not before the column."""
    target = TargetDepth()
    target.measure(BOX, SIZE, person(0.5, 4.8, 9.0), 0, 1)
    for i in range(1, 80):
        assert not target.may_be_in(BOX, SIZE, wall(3.9), i * SECOND // 20, 1)
    assert target.may_be_in(BOX, SIZE, person(0.5, 5.9, 9.0), 4 * SECOND, 1)
    assert target.measure(BOX, SIZE, person(0.5, 5.9, 9.0), 4 * SECOND, 1) > 5.5
    # Once it is seen again it may come to where the column was.
    for i in range(1, 40):
        metres = person(0.5, 5.9 - i * 0.05, 9.0)
        target.measure(BOX, SIZE, metres, 4 * SECOND + i * SECOND // 20, 1)
