# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import itertools

import numpy as np
import pytest
from sight import seen

from het_ros.tracking.grid_means import grid_means
from het_ros.tracking.size_regression import SizeRegression

NAMES = ["David", "Crossing", "Couple", "Car1"]


def learnt(frames, rate=0.02, first_frame=0.1):
    planes, centre, size = seen(frames)
    regression = SizeRegression(size, 1.2, rate, first_frame)
    regression.learn(planes, centre, 1.0)
    return regression


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("zoom", [0.94, 0.97, 1.0, 1.03, 1.06])
def test_a_known_zoom_of_a_real_frame_is_found(sequence, name, zoom):
    frames = sequence(name)
    regression, growth = learnt(frames), 1.0
    for _ in range(6):
        planes, centre, _ = seen(frames, zoom / growth)
        growth *= regression.change(planes, centre)
    assert growth == pytest.approx(zoom, abs=0.015)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("beside", [(0.03, 0.0), (0.0, -0.03), (-0.02, 0.02)])
def test_a_place_beside_the_target_changes_no_size(sequence, name, beside):
    frames = sequence(name)
    planes, centre, _ = seen(frames, beside=beside)
    assert learnt(frames).change(planes, centre) == pytest.approx(1.0, abs=0.02)


def test_it_is_ridge_regression():
    """Of noise, in one frame: the answer of a plain least-squares problem."""
    rng = np.random.default_rng(0)
    planes = tuple(rng.integers(0, 256, (60, 70), np.uint8) for _ in range(2))
    centre, size = np.array([35.0, 30.0]), np.array([30.0, 26.0])
    regression = SizeRegression((30, 26), 1.0, 0.1, 0.0)
    regression.learn(planes, centre, 1.0)

    def means(place, logarithm):
        return grid_means(planes, place, np.exp(logarithm) * size[None], (5, 5))[0]

    def features(place, logarithm):
        return (means(place, logarithm) - mean) / (deviation[:, None] + 1)

    shifts = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    samples = [(centre + 0.04 * np.array(s) * size, 0.0) for s in shifts]
    samples += [(centre, k) for k in (-0.1, -0.05, 0.05, 0.1)]
    first = np.array([means(*sample) for sample in samples])
    mean, deviation = first.mean(axis=0), first.std(axis=(0, 1, 3))
    samples += [(centre, 0.0)] * 9
    design = np.array([[*features(*sample).ravel(), 1.0] for sample in samples])
    wanted = [-logarithm for _, logarithm in samples]
    weight = 3 * (design[:, :-1] ** 2).mean()
    penalty = np.sqrt(weight * len(samples)) * np.eye(design.shape[1])[:-1]
    stacked = np.vstack([design, penalty])
    answers = np.concatenate([wanted, np.zeros(len(penalty))])
    slow = np.linalg.lstsq(stacked, answers, rcond=None)[0]
    for shift in (0.0, 1.5, -3.0):
        place = centre + shift
        answer = np.log(regression.change(planes, place))
        assert answer == pytest.approx([*features(place, 0.0).ravel(), 1.0] @ slow, abs=2e-4)


def test_a_target_that_was_learnt_larger_is_as_it_should_be(sequence):
    frames = sequence("David")
    regression = learnt(frames, rate=1.0, first_frame=0.0)
    planes, centre, _ = seen(frames, 1.05)
    for _ in range(2):
        regression.learn(planes, centre, 1.05)
    planes, centre, _ = seen(frames)
    assert regression.change(planes, centre) == pytest.approx(1.0, abs=0.01)


def test_every_second_frame_is_learnt(sequence):
    planes, centre, _ = seen(sequence("David"))
    empty = tuple(np.zeros_like(plane) for plane in planes)
    answers = []
    regression = learnt(sequence("David"), rate=0.1)
    for plane in (planes, empty, empty, planes):
        answers.append(regression.change(planes, centre + 2.0))
        regression.learn(plane, centre, 1.0)
    answers.append(regression.change(planes, centre + 2.0))
    changes = [after != before for before, after in itertools.pairwise(answers)]
    assert changes == [False, True, False, True]


def test_nothing_to_see_keeps_the_size():
    flat = (np.full((30, 40), 77, np.uint8),)
    regression = SizeRegression((12, 16), 1.2, 0.02, 0.1)
    regression.learn(flat, np.array([20.0, 15.0]), 1.0)
    assert regression.change(flat, np.array([20.0, 15.0])) == pytest.approx(1.0, abs=0.05)


def test_nothing_learnt_is_an_error():
    regression = SizeRegression((12, 16), 1.2, 0.02, 0.1)
    with pytest.raises(RuntimeError, match="call learn first"):
        regression.change((np.zeros((30, 40), np.uint8),), np.array([20.0, 15.0]))
