# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
import reference

from het_ros.tracking.motion import AdaptiveKalman


def kalman(acceleration=300.0, noise=2.0):
    return AdaptiveKalman(np.array([50.0, 60.0]), acceleration, noise, 1 / 30, 1.0)


def test_steps_as_computed_by_hand():
    rng = np.random.default_rng(0)
    fast, slow = kalman(), reference.Kalman((50, 60), 300, 2, 1.0)
    for _ in range(30):
        dt, weight = rng.uniform(0.01, 0.3), rng.uniform(0.1, 0.9)
        z = rng.normal(size=2) * 5 + [50, 60]
        fast.predict(dt)
        fast.correct(z, weight)
        slow.step(dt, lambda _, z=z, weight=weight: (z, weight))
        np.testing.assert_allclose([*fast.centre, *fast.velocity], slow.x)
        np.testing.assert_allclose(fast.covariance, slow.p, atol=1e-9)


def test_follows_a_constant_velocity_over_uneven_steps():
    motion, t = kalman(noise=1.0), 0.0
    for dt in [0.03, 0.05, 0.1, 0.02, 0.2] * 12:
        t += dt
        motion.predict(dt)
        motion.correct(np.array([50 + 40 * t, 60 - 25 * t]), 0.5)
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
    motion.correct(np.array([51.0, 61.0]), 0.5)
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
        motion.correct(np.array([60.0, 60.0]), weight)
        moved.append(motion.centre[0])
    assert 50 < moved[0] < moved[1] < 60


def test_uncertainty_grows_without_measurements():
    motion = kalman()
    before = motion.covariance
    motion.predict(0.1)
    motion.coast()
    assert (np.diag(motion.covariance)[:2] > np.diag(before)[:2]).all()
    np.testing.assert_allclose(motion.covariance, motion.covariance.T)


def walking(speed=(40.0, -25.0), seconds=3.0, dt=1 / 30, shake=0.0):
    """A filter that has watched a steady walk, and where it then is."""
    rng, motion, t = np.random.default_rng(0), kalman(), 0.0
    centre = np.array([50.0, 60.0])
    while t < seconds:
        t += dt
        motion.predict(dt)
        motion.correct(centre + t * np.array(speed) + shake * rng.normal(size=2), 0.6)
    return motion, centre + t * np.array(speed)


@pytest.mark.parametrize("dt", [1 / 60, 1 / 30, 0.1])
def test_a_hidden_target_goes_on_and_comes_to_rest(dt):
    """It moves as it moved, slower and slower, and never farther than a finite way."""
    motion, start = walking(dt=dt)
    places, speeds = [motion.centre], [40.0]
    for _ in range(int(6 / dt)):
        motion.predict(dt)
        motion.coast()
        places.append(motion.centre)
        speeds.append(np.hypot(*motion.velocity))
    way = np.array(places) - start
    assert way[1] @ [40, -25] > 0
    assert (np.diff(speeds[1:]) < 0).all()
    assert speeds[-1] < 0.01
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert steps[-1] < 1e-2
    along = way[-1] / np.array([40, -25])
    np.testing.assert_allclose(along, along.mean(), rtol=0.1)  # in the direction it had
    assert 0.2 < along.mean() < 2  # as far as it would have come in that many s


def test_the_way_coasted_does_not_depend_on_the_frame_rate():
    ways = []
    for dt in (1 / 60, 1 / 15):
        motion, start = walking(dt=1 / 30)
        for _ in range(round(2 / dt)):
            motion.predict(dt)
            motion.coast()
        ways.append(np.linalg.norm(motion.centre - start))
    assert ways[0] == pytest.approx(ways[1], rel=0.15)


def test_coasting_is_as_steady_as_the_walk_was():
    """The shake of the last frame's velocity is not what a hidden target goes on with."""
    steady = []
    for seed_shake in (0.0, 3.0):
        motion, _ = walking(shake=seed_shake)
        motion.predict(1 / 30)
        motion.coast()
        steady.append(motion.velocity)
    np.testing.assert_allclose(steady[1], steady[0], atol=15)


def test_uncertainty_grows_all_the_while_and_stays_symmetric():
    motion, _ = walking()
    before = np.diag(motion.covariance)[:2]
    for _ in range(90):
        motion.predict(1 / 30)
        motion.coast()
        now = np.diag(motion.covariance)[:2]
        assert (now > before).all()
        before = now
        np.testing.assert_allclose(motion.covariance, motion.covariance.T)
    assert (np.linalg.eigvalsh(motion.covariance) > 0).all()


def test_a_target_that_came_back_starts_again():
    motion, fresh = walking()[0], kalman()
    for _ in range(20):
        motion.predict(1 / 30)
        motion.coast()
    motion.restart(np.array([300.0, 10.0]))
    np.testing.assert_array_equal(motion.centre, [300, 10])
    assert motion.velocity == (0, 0)
    np.testing.assert_allclose(motion.covariance, fresh.covariance)
    motion.predict(1 / 30)
    motion.coast()  # nothing is left of the walk before
    np.testing.assert_allclose(motion.centre, [300, 10], atol=1e-9)


def test_a_camera_that_shakes_does_not_move_who_walks_in_the_scene():
    """The same walk twice, once under a camera that shakes: velocity and covariance are alike."""
    rng = np.random.default_rng(7)
    steady, shaken, place = kalman(), kalman(), np.zeros(2)
    for step in range(1, 30):
        way, walked = rng.normal(size=2) * 30, np.array([50 + 4.0 * step, 60 - 2.0 * step])
        place = place + way
        steady.predict(1 / 30)
        shaken.predict(1 / 30)
        shaken.shift(way)
        if step % 7 == 6:  # hidden for a frame
            steady.coast()
            shaken.coast()
        else:
            steady.correct(walked, 0.5)
            shaken.correct(walked + place, 0.5)
        np.testing.assert_allclose(shaken.centre, steady.centre + place)
        np.testing.assert_allclose(shaken.velocity, steady.velocity, atol=1e-6)
    np.testing.assert_allclose(shaken.covariance, steady.covariance)


def test_a_velocity_counted_from_elsewhere_carries_on_as_before():
    motion = kalman()
    for step in range(1, 20):
        motion.predict(1 / 30)
        motion.correct(np.array([50 + 4.0 * step, 60]), 0.5)
    before = np.array(motion.velocity)
    motion.change_velocity(np.array([-30.0, 10.0]))
    np.testing.assert_allclose(motion.velocity, before + np.array([-30, 10]))
    motion.predict(0.1)
    motion.shift(np.array([3.0, -1.0]))
    np.testing.assert_allclose(motion.centre, np.array([126, 60]) + before * 0.1, atol=1.5)
