# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import dataclasses

import pytest

from het_ros import TrackerConfig
from het_ros.tracking.parameter import parameters_of


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"sub_patches": 0}, "sub_patches lies in"),
        ({"sub_patches": 2.5}, "takes a int"),
        ({"seed": True}, "takes a int"),
        ({"learning_rate": float("nan")}, "lies in"),
        ({"learning_rate": 1.01}, "lies in"),
        ({"learning_rate": "high"}, "takes a float"),
        ({"background": 1}, "takes a bool"),
        ({"network": 3}, "takes a str"),
    ],
)
def test_what_does_not_fit_is_refused(change, says):
    with pytest.raises(ValueError, match=says):
        TrackerConfig(**change)


def test_whole_numbers_pass_as_floats():
    assert TrackerConfig(search_radius=25).search_radius == 25


def test_configurations_are_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        TrackerConfig().seed = 4


@pytest.mark.parametrize("declared", parameters_of(TrackerConfig), ids=lambda p: p.name)
def test_every_parameter_is_declared_in_full(declared):
    assert declared.doc
    if type(declared.default) in (int, float):
        assert declared.low <= declared.default <= declared.high
        for edge in (declared.low, declared.high):
            declared.check(type(declared.default)(edge))


def test_there_are_at_most_25_parameters():
    assert len(parameters_of(TrackerConfig)) <= 25
