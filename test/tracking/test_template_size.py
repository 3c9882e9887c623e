# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from het_ros.tracking.template import Template
from het_ros.tracking.template_size import TemplateSize, size_slope

CENTRE = np.array([30.0, 30.0])


def square(side):
    """One channel (60, 60) with a bright square of that side around the centre."""
    plane = np.zeros((60, 60), np.uint8)
    low = 30 - side // 2
    plane[low : low + side, low : low + side] = 200
    return (plane,)


def template():
    """Of a target 24 cells wide: bright in its middle half, dark around it, about 1 in all."""
    weights = np.full((24, 1, 24), -1.0, np.float32)
    weights[6:18, :, 6:18] = 1.0
    weights /= 200 * 144
    return Template(weights, 0.0)


@pytest.mark.parametrize(("side", "sign"), [(8, -1), (10, -1), (14, 1), (16, 1)])
def test_the_slope_leads_to_the_size_at_which_it_fits(side, sign):
    assert sign * size_slope(square(side), CENTRE, template()) > 0.1


def test_it_is_over_the_score():
    doubled = Template(2 * template().weights, 0.0)
    once = size_slope(square(14), CENTRE, template())
    assert size_slope(square(14), CENTRE, doubled) == pytest.approx(once, rel=1e-4)


@pytest.mark.parametrize("side", [8, 12, 18])
def test_it_is_what_a_slow_sum_gives(side):
    def score(size):
        total = 0.0
        for row in range(24):
            for column in range(24):
                x = 30 + size * (column - 11.5 + np.linspace(-0.45, 0.45, 10))
                y = 30 + size * (row - 11.5 + np.linspace(-0.45, 0.45, 10))
                cell = square(side)[0][np.ix_(y.astype(int), x.astype(int))].mean()
                total += weights[row, column] * cell
        return total

    weights = template().weights[:, 0]
    wanted = (score(1.08) - score(0.92)) / 0.16 / max(abs(score(1.0)), 0.2)
    found = size_slope(square(side), CENTRE, template())
    assert found == pytest.approx(wanted, rel=0.05, abs=0.15)


def test_the_first_looks_draw_nothing_and_later_ones_little():
    size = TemplateSize()
    ratios = [size.change(square(12), CENTRE, template()) for _ in range(8)]
    assert ratios == [1.0] * 8
    for _ in range(30):
        size.change(square(12), CENTRE, template())
    larger = size.change(square(18), CENTRE, template())
    smaller = size.change(square(8), CENTRE, template())
    assert 1 / 1.006 < smaller < 1 < larger < 1.006
    assert math.log(larger) == pytest.approx(0.005)  # no more, whatever the slope


def test_every_second_frame_is_looked_at():
    size = TemplateSize()
    assert [size.is_due() for _ in range(6)] == [False, True] * 3
