# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Agreement, disagreement and size, as tables."""

import dataclasses
import math

import numpy as np
import pytest

from het_ros.tracking.fitted import FITTED
from het_ros.tracking.middle.fusion import (
    Disagreement,
    FusionConfig,
    followed_size,
    fused_place,
    network_is_right,
)

from .proposals import SIZE, proposal

CONFIG = FusionConfig()
# Two places 40 px apart, of which the prediction is in the middle.
TWO = Disagreement(0.9, 0.1, -0.2, 0.8, (120.0, 50.0), (80.0, 50.0), (100.0, 50.0), 20.0)


def test_a_common_place_is_nearer_to_the_networks():
    ours, theirs = np.array([10.0, 20.0]), np.array([20.0, 10.0])
    np.testing.assert_allclose(fused_place(ours, theirs), [16, 14])
    np.testing.assert_allclose(fused_place(ours, ours), ours)


@pytest.mark.parametrize(
    ("changed", "evidence"),
    [
        ({}, (0.8, -0.25, 0.0)),
        ({"score_ours": 0.9}, (0.0, -0.25, 0.0)),
        ({"votes": 0.0}, (0.8, 0.0, 0.0)),
        ({"usual": 0.4}, (0.8, -0.5, 0.0)),
        ({"ours": (100.0, 50.0)}, (0.8, -0.25, 1.0)),
        ({"theirs": (100.0, 40.0)}, (0.8, -0.25, -0.5)),
        ({"theirs": (400.0, 50.0)}, (0.8, -0.25, 0.5)),  # no worse than 1.5 sides away
    ],
)
def test_evidence_is_what_one_place_has_more_than_the_other(changed, evidence):
    found = dataclasses.replace(TWO, **changed).evidence(1.5)
    np.testing.assert_allclose(found, evidence, atol=1e-12)


@pytest.mark.parametrize(
    ("changed", "right"),
    [
        ({}, True),
        ({"score_ours": 0.9}, False),  # it says as much of the other place
        ({"votes": -2.0}, False),  # the ensembles see nothing there
        ({"score_ours": 0.6}, True),
        ({"score_ours": 0.6, "ours": (100.0, 50.0)}, False),  # where it was expected
    ],
)
def test_the_likelier_of_two_places_is_chosen(changed, right):
    config = FusionConfig(by_score=4.0, by_votes=2.0, by_distance=-1.0, bias=-0.4)
    assert network_is_right(dataclasses.replace(TWO, **changed), config) is right


def test_the_fitted_weights_follow_a_sure_network_and_no_other():
    assert network_is_right(TWO, CONFIG)
    assert not network_is_right(dataclasses.replace(TWO, score_theirs=0.1, score_ours=0.9), CONFIG)
    assert not network_is_right(dataclasses.replace(TWO, votes=-3.0), CONFIG)


def test_a_calibration_gives_the_weights():
    fitted = dataclasses.replace(FITTED, network_is_right=(1.0, 2.0, 3.0, 4.0))
    config = FusionConfig.of(fitted)
    assert (config.by_score, config.by_votes, config.by_distance, config.bias) == (1, 2, 3, 4)
    assert FusionConfig.of(FITTED) == CONFIG


@pytest.mark.parametrize(
    ("ratio", "score", "steady", "taken"),
    [
        ((1.0, 1.0), 1.0, 1.0, (0.0, 0.0)),
        ((1.2, 1.2), 0.0, 1.0, (0.0, 0.0)),
        ((1.2, 1.2), 1.0, 1.0, (0.4, 0.4)),  # the area
        ((0.8, 0.8), 1.0, 1.0, (0.4, 0.4)),
        ((1.2, 1 / 1.2), 1.0, 1.0, (0.2, 0.2)),  # the aspect, more slowly
        ((1.2, 1.2), 0.5, 0.8, (0.16, 0.16)),  # by score and steadiness
        ((1.2, 1.0), 1.0, 1.0, (0.3, None)),  # both: half area, half aspect
    ],
)
def test_the_size_follows_a_part_of_the_way(ratio, score, steady, taken):
    found = followed_size(SIZE, proposal(SIZE * ratio, score, steady))
    for side, times, part in zip(found / SIZE, ratio, taken, strict=True):
        if part is not None:
            assert math.log(side) == pytest.approx(part * math.log(times), abs=1e-12)


def test_the_size_arrives_where_the_network_stays():
    size, wanted = SIZE, np.array([35.0, 28.0])
    for _ in range(80):
        size = followed_size(size, proposal(wanted))
    np.testing.assert_allclose(size, wanted, rtol=1e-3)
