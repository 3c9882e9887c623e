# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Probability and states of made frames: what was found is given, what is decided is asked."""

from dataclasses import astuple

import numpy as np
import pytest

from het_ros import State
from het_ros.tracking.middle.fusion import Agreement
from het_ros.tracking.top.confidence import (
    Confidence,
    ConfidenceConfig,
    Features,
    Observation,
    probability,
)

TRACKING, COASTING, LOST = State.TRACKING, State.COASTING, State.LOST
CONFIG = ConfidenceConfig()
DT = 0.1
# What is found of a target that is there, is half like itself, or is not there.
SURE = {
    "score": 0.9,
    "colour": 0.7,
    "distractor": 0.2,
    "moved": 0.02,
    "spread": 0.05,
    "speed": 0.0,
}
GONE = {
    "score": 0.05,
    "colour": 0.1,
    "distractor": 0.02,
    "moved": 0.9,
    "spread": 0.3,
    "speed": 0.0,
}
MAY_BE = {"score": 0.4, "moved": 0.2, "spread": 2.0}


def judged(confidence, frames=1, occluded=False, dt=DT, **changed):
    """The last of some equal frames' decisions."""
    for _ in range(frames):
        seen = Observation(**{**SURE, **changed}, occluded=occluded)
        decision = confidence.judge(seen, dt)
    return decision


def settled(lost_after=2.0):
    """Confidence in a target that has been there for a while."""
    confidence = Confidence(lost_after)
    judged(confidence, 60)
    return confidence


def features(**changed):
    seen = {**SURE, "usual": 0.9, "relative": 1.0, **changed}
    return Features(**{name: seen[name] for name in Features.__dataclass_fields__})


def likely(low, high):
    """Values of the frame whose probability lies in [low, high), by the score alone."""
    for score in np.linspace(1.2, 0.0, 241):
        confidence = settled()
        found = judged(confidence, score=score, colour=0.7 * score / 0.9)
        if low <= probability(confidence.features) < high:
            return {"score": score, "colour": 0.7 * score / 0.9}, found
    raise AssertionError(f"no score gives a probability in [{low}, {high})")


def test_probability_is_between_nothing_and_certainty():
    values = [probability(features(**changed)) for changed in (SURE, GONE)]
    assert 0 < values[1] < CONFIG.hidden < CONFIG.back < values[0] < 1


@pytest.mark.parametrize(
    ("name", "worse"),
    [("colour", 0.1), ("distractor", 0.9), ("moved", 0.9), ("spread", 0.5)],
)
def test_what_speaks_against_it_makes_it_less_likely(name, worse):
    assert probability(features(**{name: worse})) < probability(features())


@pytest.mark.parametrize("name", Features.__dataclass_fields__)
@pytest.mark.parametrize("value", [-1e9, 0.0, 1e9])
def test_any_number_gives_a_probability(name, value):
    assert 0 <= probability(features(**{name: value})) <= 1


def test_beyond_their_ranges_features_say_no_more():
    inside = Features(0.9, 1.3, 1.3, 1.5, 1.0, 0.2)
    beyond = Features(0.9, 9.0, 9.0, 9.0, 9.0, 0.2)
    below = Features(*(-x for x in astuple(inside)))
    assert beyond.clipped() == inside.clipped() == astuple(inside)
    assert set(below.clipped()) == {0.0}


def test_what_is_sure_is_followed_and_learnt_whole():
    decision = judged(settled())
    assert (decision.state, decision.follow, decision.returned) == (TRACKING, True, False)
    assert decision.weight == 1.0
    assert decision.score > CONFIG.learn_whole


def test_features_compare_with_what_was_usual():
    """Averages take in a twentieth of every learnt frame, and nothing of any other."""
    confidence = Confidence(2.0)
    usual, colour = 1.0, SURE["colour"]
    for _ in range(30):
        judged(confidence)
        found = confidence.features
        assert found.usual == pytest.approx(usual)
        assert found.relative == pytest.approx(SURE["score"] / usual)
        assert found.colour == pytest.approx(SURE["colour"] / colour)
        assert found.distractor == pytest.approx(SURE["distractor"] / SURE["score"])
        usual += CONFIG.average_rate * (SURE["score"] - usual)
    judged(confidence, 5, **GONE)
    assert confidence.features.usual == pytest.approx(usual)


def test_the_longer_unseen_the_less_a_distance_says():
    """A distance counts over one more than the frames since the target was recognised."""
    confidence = settled()
    for unseen in range(4):
        judged(confidence, **GONE)
        assert confidence.features.moved == pytest.approx(GONE["moved"] / (1 + unseen))
    assert judged(confidence).returned
    judged(confidence, **GONE)
    assert confidence.features.moved == pytest.approx(GONE["moved"])


def test_what_a_network_says_counts():
    """Its score and what is like the first box speak for a place, its own far away against."""
    shown = features(relative=0.5, colour=0.5)
    sure, unsure, far, other = (
        probability(shown, Agreement(*said))
        for said in ((0.95, 0.1, 0.8), (0.05, 0.1, 0.8), (0.95, 1.0, 0.8), (0.95, 0.1, 0.4))
    )
    assert max(unsure, far, other) < sure


@pytest.mark.parametrize(
    ("low", "high", "state", "learnt"),
    [
        (0.0, CONFIG.hidden, COASTING, "nothing"),
        (CONFIG.hidden, CONFIG.learn_from, TRACKING, "nothing"),
        (CONFIG.learn_from, CONFIG.learn_whole, TRACKING, "part"),
        (CONFIG.learn_whole, 1.0, TRACKING, "all"),
    ],
)
def test_one_probability_decides_what_is_followed_and_learnt(low, high, state, learnt):
    _, decision = likely(low + 1e-3, high)
    assert decision.state is state
    assert learnt == {0.0: "nothing", 1.0: "all"}.get(decision.weight, "part")
    if state is TRACKING:
        assert low <= decision.score < high


def test_a_hidden_target_must_be_likelier_to_be_back_than_to_stay():
    """Between the two thresholds the state is what it was."""
    doubt, _ = likely(CONFIG.hidden + 0.05, CONFIG.back - 0.05)
    confidence = settled()
    assert judged(confidence, **doubt).state is TRACKING
    assert judged(confidence, **GONE).state is COASTING
    assert judged(confidence, **doubt).state is COASTING
    back = judged(confidence)
    assert (back.state, back.follow) == (TRACKING, True)
    assert judged(confidence, **doubt).state is TRACKING


@pytest.mark.parametrize(
    ("frames", "state"),
    [
        ([SURE] * 3, TRACKING),
        ([GONE], COASTING),
        ([GONE] * 9, COASTING),
        ([GONE] * 12, LOST),
        ([GONE] * 5 + [SURE] + [GONE] * 7, COASTING),  # the time starts again
        ([GONE] * 12 + [SURE], TRACKING),  # what is recognised is back from LOST as well
        ([GONE] * 12 + [SURE, GONE], COASTING),
    ],
)
def test_states_frame_by_frame(frames, state):
    confidence = settled(lost_after=1.0)
    for frame in frames:
        decision = judged(confidence, **frame)
    assert decision.state is state
    if state is LOST:
        assert decision.score == 0.0
    elif state is COASTING:
        assert decision.score <= CONFIG.back


def test_the_time_until_lost_is_measured_in_seconds():
    slow, fast = settled(1.0), settled(1.0)
    assert judged(slow, 3, dt=0.4, **GONE).state is LOST
    assert judged(fast, 30, dt=0.01, **GONE).state is COASTING


def test_what_is_occluded_coasts_whatever_it_looks_like():
    confidence = settled()
    decision = judged(confidence, occluded=True)
    assert (decision.state, decision.follow, decision.weight) == (COASTING, False, 0.0)
    assert decision.score <= CONFIG.back
    assert judged(confidence).returned


@pytest.mark.parametrize(
    ("changed", "follow"),
    [
        ({}, True),  # it may only have changed
        ({"moved": 1.6}, False),  # too far from the prediction
        ({"score": 0.2}, False),  # nothing like it is there
        ({"similarity": 0.5}, False),  # other colours, which stand still in the scene
        ({"similarity": 0.5, "speed": 1.0}, True),  # what hides it does not walk
    ],
)
def test_the_box_stays_on_what_may_be_the_target(changed, follow):
    confidence = settled()
    decision = judged(confidence, **{**GONE, **MAY_BE, **changed})
    assert (decision.state, decision.follow, decision.weight) == (COASTING, follow, 0.0)
    assert confidence.unseen == (0 if follow else 1)
    assert judged(confidence).returned is not follow


def test_without_a_network_colours_are_not_asked_for():
    confidence = settled()
    judged(confidence, 8, **GONE)
    assert judged(confidence, similarity=None).state is TRACKING


@pytest.mark.parametrize("lost_after", [0.5, 2.0])  # hidden, and lost
def test_who_wears_other_colours_is_not_the_hidden_target(lost_after):
    confidence = settled(lost_after)
    hidden = judged(confidence, 8, **GONE)
    other = judged(confidence, 8, similarity=CONFIG.stay_alike - 0.01)
    assert (other.follow, other.state) == (False, hidden.state)
    assert other.score <= CONFIG.unsure
    far = judged(confidence, moved=1.0, similarity=CONFIG.alike - 0.01)
    assert (far.follow, far.state) == (False, hidden.state)
    decision = judged(confidence, similarity=CONFIG.alike)
    assert (decision.state, decision.returned) == (TRACKING, True)


def test_who_is_in_view_may_change_its_colours():
    assert judged(settled(), similarity=0.0).state is TRACKING


def test_of_two_that_look_alike_neither_is_learnt_nor_sure():
    confidence = settled()
    decision = judged(confidence, distractor=0.95 * SURE["score"])
    assert decision.weight == 0.0
    assert decision.score <= CONFIG.back


@pytest.mark.parametrize("frames", [1, CONFIG.new, CONFIG.new + 1])
def test_a_new_target_is_followed_and_learnt_whatever_is_said(frames):
    decision = judged(Confidence(2.0), frames, **GONE)
    if frames <= CONFIG.new:
        assert (decision.state, decision.follow) == (TRACKING, True)
        assert decision.weight > 0
    else:
        assert decision.state is COASTING


@pytest.mark.parametrize("colour", [0.0, 1e-12])
def test_a_target_without_colours(colour):
    confidence = Confidence(2.0)
    decision = judged(confidence, 20, colour=colour)
    assert decision.state is TRACKING
    assert np.isfinite(astuple(confidence.features)).all()
