# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Estimate, State, lasting_deviation
from het_ros.tracking.motion import Motion


def test_less_sure_is_less_exact():
    deviations = [lasting_deviation(score) for score in (1.0, 0.8, 0.5, 0.0)]
    assert deviations == sorted(set(deviations))
    assert deviations[0] > 0


@pytest.mark.parametrize("with_motion", [False, True])
def test_a_prediction_goes_on_and_is_less_sure(with_motion):
    motion = None
    if with_motion:
        motion = Motion(np.array([60.0, 0]), np.array([0.0, 30]), 9 * np.eye(2), 4.0, 0.07, 50.0)
    place = Box(10.0, 20.0, 30.0, 40.0)
    covariance = np.diag([4.0, 4, 9, 9])
    now = Estimate(place, (60.0, 30.0), covariance, 0.9, State.TRACKING, motion=motion)
    later, same = now.predict(0.2), now.predict(0)
    assert (same.box, same.velocity) == (place, now.velocity)
    np.testing.assert_allclose(same.covariance, covariance)
    assert later.box.x == pytest.approx(22, abs=0.4) and later.box.w == place.w
    assert np.trace(later.covariance[:2, :2]) > 8
    assert np.linalg.eigvalsh(later.covariance).min() > 0
    assert (now.covariance == covariance).all()
    np.testing.assert_allclose(
        now.predict(0.1).predict(0.1).box.as_tuple(), later.box.as_tuple(), rtol=1e-9
    )


@pytest.mark.parametrize("dt", [-0.1, math.nan, math.inf])
def test_a_time_ahead_is_no_less_than_none(dt):
    with pytest.raises(ValueError, match="0 or more"):
        Estimate(Box(0, 0, 9, 9), (0.0, 0.0), np.eye(4), 1.0, State.TRACKING).predict(dt)
