# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import subprocess
import sys

import numpy as np
import pytest

from het_ros.tracking.paper.kalman import AdaptiveKalman

from . import reference


def kalman(acceleration=300.0, noise=2.0):
    return AdaptiveKalman(np.array([50.0, 60.0]), acceleration, noise, 1 / 30, 1.0)


def test_steps_as_computed_by_hand():
    rng = np.random.default_rng(0)
    fast, slow = kalman(), reference.Kalman((50, 60), 300, 2, 1.0)
    for _ in range(30):
        dt, weight = rng.uniform(0.01, 0.3), rng.uniform(0.1, 0.9)
        z = rng.normal(size=2) * 5 + [50, 60]
        fast.predict(dt)
        fast.adapt(weight)
        fast.correct(z)
        slow.step(dt, lambda _, z=z, weight=weight: (z, weight))
        np.testing.assert_allclose([*fast.centre, *fast.velocity], slow.x)
        np.testing.assert_allclose(fast.covariance, slow.p, atol=1e-9)


def test_follows_a_constant_velocity_over_uneven_steps():
    motion, t = kalman(noise=1.0), 0.0
    for dt in [0.03, 0.05, 0.1, 0.02, 0.2] * 12:
        t += dt
        motion.predict(dt)
        motion.adapt(0.5)
        motion.correct(np.array([50 + 40 * t, 60 - 25 * t]))
    np.testing.assert_allclose(motion.velocity, [40, -25], atol=0.5)
    np.testing.assert_allclose(
        motion.predict(0.5), [50 + 40 * (t + 0.5), 60 - 25 * (t + 0.5)], atol=1
    )


@pytest.mark.parametrize(
    ("dt", "used"), [(0.1, 0.1), (0.0, 1 / 30), (-5.0, 1 / 30), (1e9, 1.0), (1e-9, 1e-9)]
)
def test_which_step_is_taken(dt, used):
    assert kalman().step(dt) == used
    motion = kalman()
    motion.predict(dt)
    motion.adapt(0.5)
    motion.correct(np.array([51.0, 61.0]))
    assert np.isfinite(motion.covariance).all()


@pytest.mark.parametrize("dt", [float("nan"), float("inf")])
def test_time_must_be_a_number(dt):
    with pytest.raises(ValueError, match="finite"):
        kalman().predict(dt)


def test_agreeing_sub_patches_are_trusted_more():
    moved = []
    for weight in (0.2, 0.8):
        motion = kalman()
        motion.predict(1 / 30)
        motion.adapt(weight)
        motion.correct(np.array([60.0, 60.0]))
        moved.append(motion.centre[0])
    assert 50 < moved[0] < moved[1] < 60


@pytest.mark.parametrize(
    "module", ["het_ros.tracking.features.frame", "het_ros.tracking.paper.config"]
)
def test_what_others_import_does_not_load_the_filters_library(module):
    """It brings SciPy's statistics and matplotlib: 70 MB that only the paper's tracker pays."""
    heavy = {"filterpy", "scipy", "matplotlib"}
    code = f"import sys, {module}; assert not {heavy} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
