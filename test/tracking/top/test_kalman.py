# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The box's filter, beside a library's."""

import subprocess
import sys

import numpy as np
from filterpy.common import Q_discrete_white_noise
from filterpy.kalman import KalmanFilter

from het_ros.tracking.top.kalman import AdaptiveKalman


def test_it_is_filterpys():
    rng = np.random.default_rng(0)
    ours = AdaptiveKalman(np.array([50.0, 60.0]), 3000.0, 4.0, 1 / 30, 1.0)
    theirs = KalmanFilter(dim_x=4, dim_z=2)
    theirs.x, theirs.H = np.array([50.0, 60.0, 0, 0]), np.eye(2, 4)
    theirs.P = np.diag([16.0, 16.0, 9e6, 9e6])
    for _ in range(200):
        dt, weight, place = rng.uniform(0.01, 0.3), rng.uniform(0.1, 0.9), rng.normal(50, 10, 2)
        theirs.F = np.eye(4) + dt * np.eye(4, k=2)
        noise = Q_discrete_white_noise(2, dt, 3000.0**2, block_size=2, order_by_dim=False)
        theirs.predict(Q=weight * noise)
        theirs.update(place, R=(1 - weight) * 16 * np.eye(2))
        ours.predict(dt)
        ours.correct(place, weight)
        state = np.array([*ours.centre, *ours.velocity])
        np.testing.assert_allclose(state, theirs.x, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(ours.covariance, theirs.P, rtol=1e-6, atol=1e-6)


def test_the_default_tracker_does_not_load_a_filters_library():
    heavy = {"filterpy", "scipy", "matplotlib"}
    code = f"import sys, het_ros.tracking.tracker; assert not {heavy} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
