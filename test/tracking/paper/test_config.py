# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import dataclasses

import pytest

from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.parameter import parameters_of


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("sub_patches", 11),
        ("sub_patch_fraction", 3 / 4),
        ("features", 150),
        ("rectangles", 4),
        ("search_radius", 20),
        ("weight_low", 0.1),
        ("weight_high", 0.9),
    ],
)
def test_the_papers_constants(name, value):
    assert getattr(PaperConfig(), name) == value


def test_lambda_is_one_minus_the_learning_rate():
    assert 1 - PaperConfig().learning_rate == 0.85


def test_every_parameter_says_where_it_comes_from():
    for declared in parameters_of(PaperConfig):
        if declared.name != "seed":
            assert "(paper)" in declared.doc or "(chosen" in declared.doc


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"channels": ()}, "at least one"),
        ({"channels": ("infrared",)}, "one of"),
        ({"positive_radius": 9.0}, "positive_radius .* must not exceed negative_radius"),
        ({"search_radius": 5.0}, "negative_radius .* must not exceed search_radius"),
        ({"weight_low": 0.95}, "weight_low"),
        ({"learning_rate": 1.5}, "learning_rate lies in"),
        ({"features": 2.5}, "takes a int"),
    ],
)
def test_what_contradicts_is_refused(changes, says):
    with pytest.raises(ValueError, match=says):
        dataclasses.replace(PaperConfig(), **changes)
