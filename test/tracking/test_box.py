# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import pytest

from het_ros import Box


@pytest.mark.parametrize(
    ("a", "b", "iou"),
    [
        (Box(0, 0, 4, 4), Box(0, 0, 4, 4), 1),
        (Box(0, 0, 4, 4), Box(4, 0, 4, 4), 0),
        (Box(0, 0, 4, 4), Box(2, 0, 4, 4), 8 / 24),
        (Box(0, 0, 10, 10), Box(2, 3, 5, 2), 0.1),
        (Box(-3, -3, 2, 2), Box(7, 9, 1, 1), 0),
    ],
)
def test_iou(a, b, iou):
    assert a.iou(b) == pytest.approx(iou)
    assert b.iou(a) == pytest.approx(iou)


def test_centre_and_back():
    box = Box(205, 151, 17, 50)
    assert box.centre == (213.5, 176)
    assert Box.from_centre(*box.centre, box.w, box.h) == box


@pytest.mark.parametrize(
    ("degrees", "size"),
    [(0, (20, 80)), (90, (80, 20)), (-90, (80, 20)), (180, (20, 80)), (45, (58.3, 58.3))],
)
def test_turned_stays_upright_around_its_centre(degrees, size):
    turned = Box.from_centre(5, -7, 20, 80).turned(math.radians(degrees))
    assert turned.centre == pytest.approx((5, -7))
    assert (turned.w, turned.h) == pytest.approx(size, abs=0.1)


@pytest.mark.parametrize(
    ("box", "touches"),
    [
        (Box(10, 10, 5, 5), True),
        (Box(-5, -5, 5.5, 5.5), True),
        (Box(-5, 0, 5, 5), False),  # ends where the image begins
        (Box(159.5, 119.5, 9, 9), True),
        (Box(160, 0, 9, 9), False),
    ],
)
def test_touches_image(box, touches):
    assert box.touches_image(160, 120) is touches


@pytest.mark.parametrize(
    "values", [(math.nan, 0, 1, 1), (0, math.inf, 1, 1), (0, 0, 0, 1), (0, 0, 1, -1)]
)
def test_what_is_no_box(values):
    with pytest.raises(ValueError, match="a box needs"):
        Box(*values)
