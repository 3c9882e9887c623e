# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.subpixel import parabola_offset


@pytest.mark.parametrize("top", [-0.49, -0.2, 0.0, 0.13, 0.5])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_top_of_a_parabola_is_found_exactly(top, dtype):
    values = (3 - 0.7 * (np.arange(7) - (3 + top)) ** 2).astype(dtype)
    assert parabola_offset(values, 3) == pytest.approx(top, abs=1e-5)


@pytest.mark.parametrize("sigma", [1.5, 3.0])
@pytest.mark.parametrize("top", np.linspace(-0.5, 0.5, 9))
def test_the_top_of_a_gaussian_is_found_nearly(top, sigma):
    values = np.exp(-0.5 * ((np.arange(21) - (10 + top)) / sigma) ** 2)
    assert parabola_offset(values, 10) == pytest.approx(top, abs=0.05)


@pytest.mark.parametrize(
    ("values", "peak", "offset"),
    [
        ([5.0, 1.0, 0.0], 0, 0.0),  # at an end there is nothing to go by
        ([0.0, 1.0, 5.0], 2, 0.0),
        ([1.0], 0, 0.0),
        ([2.0, 2.0, 2.0], 1, 0.0),  # flat
        ([3.0, 1.0, 3.0], 1, 0.0),  # a hollow has no top
        ([0.0, 1.0, 1.0], 1, 0.5),  # between two equals
        ([1.0, 1.0, 0.0], 1, -0.5),
        ([0.0, 1.0, 1.9], 1, 0.5),  # not the highest: never farther than half a sample
    ],
)
def test_special_cases(values, peak, offset):
    assert parabola_offset(np.array(values), peak) == pytest.approx(offset)
