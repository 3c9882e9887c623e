# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.evaluation import logistic
from het_ros.evaluation.logistic import Examples, fit, held_out, probabilities, quality

pytest.importorskip("sklearn")
TRUE = (2.0, -1.0, 0.5)


def made(count=4000, sequences=400, seed=0, weights=TRUE):
    """Examples that are right with the probability of known weights."""
    rng = np.random.default_rng(seed)
    features = rng.normal(0.3, [1.0, 2.0], (count, 2))
    right = rng.random(count) < probabilities(features, weights)
    names = np.array([f"s{i * sequences // count}" for i in range(count)])
    return Examples(features, right, names, names)


def test_known_weights_are_found():
    assert fit(made(20000, 2000)) == pytest.approx(TRUE, abs=0.1)


def test_weights_are_rounded_and_the_same_each_time():
    once, again = fit(made()), fit(made())
    assert once == again
    assert all(value == round(value, 3) for value in once)


def test_each_sequence_weighs_the_same():
    long, short = made(900, 1), made(100, 1, weights=(-2.0, 1.0, 0.0))
    names = np.array(["long"] * 900 + ["short"] * 100)
    both = Examples(
        np.concatenate([long.features, short.features]),
        np.concatenate([long.right, short.right]),
        names,
        names,
    )
    sums = [both.weights[names == name].sum() for name in ("long", "short")]
    assert sums == pytest.approx([logistic.FRAMES] * 2)
    assert abs(fit(both)[0]) < 0.5, "the two contradict each other, and neither wins"


def test_a_group_is_predicted_by_a_fit_that_has_not_seen_it():
    known = made(300, 3)
    groups = np.where(known.sequences == "s2", "s1", known.sequences)
    known = Examples(known.features, known.right, known.sequences, groups)
    found = held_out(known)
    out = groups == "s1"
    turned = Examples(known.features, np.where(out, ~known.right, known.right), groups, groups)
    turned = Examples(turned.features, turned.right, known.sequences, groups)
    again = held_out(turned)
    assert np.array_equal(found[out], again[out]), "its own labels say nothing of it"
    assert not np.allclose(found[~out], again[~out])


@pytest.mark.parametrize(
    ("right", "names", "message"),
    [
        ([True] * 4, "abab", "right and frames that are wrong"),
        ([True, False] * 2, "aaaa", "two sequences"),
    ],
)
def test_too_little_is_said(right, names, message):
    known = Examples(
        np.ones((4, 1)), np.array(right), np.array(list(names)), np.array(list(names))
    )
    with pytest.raises(ValueError, match=message):
        held_out(known)


def test_quality_of_probabilities():
    names = np.array(["a"] * 4)
    known = Examples(np.zeros((4, 1)), np.array([True, True, False, False]), names, names)
    perfect = quality(np.array([1.0, 1.0, 0.0, 0.0]), known)
    assert (perfect.error, perfect.roc) == (0.0, 1.0)
    unsure = quality(np.array([0.75, 0.75, 0.75, 0.75]), known)
    assert (unsure.error, unsure.roc) == (pytest.approx(0.25), 0.5)
