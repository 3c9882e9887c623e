# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from het_ros.tracking.evidence import FAR, Evidence, probability, recognised

BACK = {"template": 0.8, "colour": 1.0, "rival": 0.3}


def test_a_target_that_was_hard_to_tell_all_along_is_less_sure():
    sure = [probability(mean, mean, 1.0, 0.4) for mean in (0.3, 0.5, 0.7, 0.9)]
    assert sure == sorted(sure)
    assert sure[0] < 0.1
    assert sure[-1] > 0.9


@pytest.mark.parametrize("worse", ["moved", "away", "spread", "rival"])
def test_less_is_recognised_the_more_speaks_against_it(worse):
    known = [recognised(Evidence(**{**BACK, worse: value})) for value in (0.1, 0.3, 0.5)]
    assert known == sorted(known, reverse=True)
    assert known[0] > known[-1]


def test_the_more_a_hidden_target_looks_as_at_first_the_more_it_is_recognised():
    known = [
        recognised(Evidence(**BACK, likeness=likeness)) for likeness in (0.1, 0.22, 0.28, 0.5, 0.9)
    ]
    assert known == sorted(set(known))
    assert known[2] == pytest.approx(recognised(Evidence(**BACK)))


@pytest.mark.parametrize("way", ["moved", "away"])
def test_far_is_no_farther_than_far(way):
    """A target that left the image may return anywhere."""
    far, farther = (recognised(Evidence(**BACK, **{way: value})) for value in (FAR, 9.0))
    assert far == farther


@pytest.mark.parametrize("value", [20.0, -20.0, -1e4, 1e30, 1e-12, 0.0])
def test_no_evidence_breaks_a_probability(value):
    assert 0 <= probability(value, abs(value), abs(value), value) <= 1
    assert 0 <= recognised(Evidence(value, abs(value), value, likeness=value)) <= 1
