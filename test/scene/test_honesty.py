# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box, Estimate, State
from het_ros.scene import SceneConfig
from het_ros.scene.honesty import Moment, f_of_visible, followed, honesty

RATE = 10.0


def moment(letter, visible=1.0, overlap=0.8, elsewhere=0.0, score=0.9):
    state = {"T": State.TRACKING, "C": State.COASTING, "L": State.LOST}[letter]
    box = Box(0.0, 0.0, 10.0, 10.0)
    return Moment(Estimate(box, (0.0, 0.0), np.eye(4), score, state), visible, overlap, elsewhere)


FIRST = moment("T")


@pytest.mark.parametrize(
    ("states", "visible", "f"),
    [
        ("TTTT", "1111", 1.0),
        ("TTCC", "1100", 1.0),
        ("TTTT", "1100", 2 / 3),  # never gives up
        ("TTCC", "1111", 2 / 3),  # gives up what is in sight
        ("LLLL", "1111", 0.0),
        ("LLLL", "0000", 1.0),  # nothing to see, nothing said
        ("CCTT", "1100", 0.0),
    ],
)
def test_f_of_visible(states, visible, f):
    moments = [moment(s, float(v)) for s, v in zip(states, visible, strict=True)]
    assert f_of_visible(moments) == pytest.approx(f)


def test_a_target_that_comes_back():
    hidden = [moment("C", 0.0, 0.2) for _ in range(5)]
    late = [moment("C", 1.0, 0.1) for _ in range(3)]
    found = honesty([FIRST, moment("T"), *hidden, *late, moment("T"), moment("T")], RATE)
    assert found.back_after == pytest.approx(0.3)
    assert found.ends_on_target
    assert (found.confident_wrong, found.confident_other) == (0, 0)


def test_a_target_that_is_not_found_again():
    found = honesty([FIRST, moment("C", 0.0), moment("L", 1.0, 0.0), moment("L", 1.0, 0.0)], RATE)
    assert found.back_after is None
    assert not found.ends_on_target


@pytest.mark.parametrize(
    ("moments", "wrong", "other"),
    [
        ([moment("T", overlap=0.1)], 1, 0),  # on the ground
        ([moment("T", overlap=0.1, score=0.4)], 0, 0),  # but it doubts
        ([moment("C", overlap=0.1)], 0, 0),
        ([moment("T", overlap=0.1, elsewhere=0.7)], 1, 1),
        ([moment("T", overlap=0.5, elsewhere=0.4)], 0, 0),  # more on the target
        ([moment("T", 0.5, 0.1, 0.7), moment("T")], 1, 0),  # while one covers the other
        ([moment("T", 0.5, 0.1, 0.7), moment("T", 1.0, 0.1, 0.7)], 2, 1),
    ],
)
def test_confidence_in_what_is_not_the_target(moments, wrong, other):
    found = honesty([FIRST, *moments], RATE)
    assert (found.confident_wrong, found.confident_other) == (wrong, other)


def test_a_rendered_scene_is_followed_from_its_first_frame():
    moments = followed(SceneConfig(width=160, height=120, rate=10.0, seconds=1.0))
    assert len(moments) == 10
    assert moments[0].overlap == pytest.approx(1.0)
    assert all(m.overlap > 0.3 and m.visible > 0.9 for m in moments)
