# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math
from dataclasses import replace

import pytest

from het_ros import State, TrackerConfig
from het_ros.tracking.evidence import Evidence
from het_ros.tracking.trust import Trust, Verdict

# Those named are what the tables below were written for, the others are the tracker's own.
LIMITS = TrackerConfig(
    hidden=0.5, doubt_template=0.75, doubt_rival=0.8, return_probability=0.65, lost_after=2.0
)
GOOD = Evidence(template=1.0, colour=0.8, rival=0.2)
BACK = {"template": 0.8, "colour": 1.0, "rival": 0.3}
GONE = Evidence(template=0.1, colour=0.1, rival=0.1)


def grown_up(limits=LIMITS, frames=60, dt=1 / 30):
    """Trust after two good seconds."""
    trust = Trust(limits)
    for _ in range(frames):
        trust.judge(GOOD, dt)
    return trust


@pytest.mark.parametrize(
    ("evidence", "verdict"),
    [
        (GOOD, Verdict.SEEN),
        (Evidence(1.4, 0.95, 0.2), Verdict.SEEN),  # better than ever
        (Evidence(0.9, 0.8, 0.78), Verdict.SEEN),  # a rival, but the target is as it was
        (Evidence(0.9, 0.8, 0.85), Verdict.DOUBTED),  # a twin: it may be either
        (Evidence(0.8, 0.5, 0.2), Verdict.DOUBTED),  # the colours are being covered
        (Evidence(0.7, 0.8, 0.3), Verdict.SEEN),  # changed, but there is nobody else
        (Evidence(0.7, 0.8, 0.65), Verdict.DOUBTED),  # changed, and somebody else looks so too
        (Evidence(0.7, 0.8, 0.9), Verdict.DOUBTED),
        (GONE, Verdict.HIDDEN),
        (Evidence(0.15, 5.0, 0.0), Verdict.HIDDEN),  # no colour excuses a shape that is gone
        (Evidence(0.65, 0.5, 0.3), Verdict.DOUBTED),  # in other light: nobody else looks so
        (Evidence(0.65, 0.5, 0.65), Verdict.HIDDEN),  # somebody else does
        (Evidence(0.3, 0.4, 0.1), Verdict.HIDDEN),  # shape and colours more than half gone
        (Evidence(0.0, 0.0, 0.0), Verdict.HIDDEN),
        (Evidence(-0.3, 0.8, -0.2), Verdict.HIDDEN),
    ],
    ids=str,
)
def test_verdicts_on_a_target_that_was_well_seen(evidence, verdict):
    trust = grown_up()
    assert trust.judge(evidence, 1 / 30) is verdict
    assert trust.state is (State.COASTING if verdict is Verdict.HIDDEN else State.TRACKING)
    assert 0 <= trust.score <= 1


@pytest.mark.parametrize(
    ("likeness", "moved", "verdict"),
    [
        (None, 0.1, Verdict.HIDDEN),
        (0.4, 0.1, Verdict.HIDDEN),
        (0.55, 0.1, Verdict.DOUBTED),  # blurred, but nothing else looks as it did at first
        (0.55, 1.5, Verdict.HIDDEN),  # far off it may be somebody in the same clothes
    ],
)
def test_who_looks_as_at_first_is_not_hidden(likeness, moved, verdict):
    faint = Evidence(0.4, 0.5, 0.65, moved=moved, likeness=likeness)
    for before in (0, 3):  # frames that it was hidden for
        trust = grown_up()
        for _ in range(before):
            trust.judge(GONE, 1 / 30)
        assert trust.judge(faint, 1 / 30) is verdict


def test_a_new_target_is_tracked():
    trust = Trust(LIMITS)
    assert trust.state is State.TRACKING
    assert trust.hidden_frames == 0
    assert trust.judge(GOOD, 1 / 30) is Verdict.SEEN


@pytest.mark.parametrize("dt", [0.01, 1 / 30, 1 / 15, 0.1, 0.25, 0.9])
def test_lost_after_the_same_time_at_every_frame_rate(dt):
    trust, coasted = grown_up(dt=dt), 0.0
    trust.judge(GONE, dt)
    while trust.state is State.COASTING:
        coasted += dt
        assert coasted < LIMITS.lost_after + 2 * dt
        assert trust.judge(GONE, dt) is Verdict.HIDDEN
    assert trust.state is State.LOST
    assert coasted == pytest.approx(LIMITS.lost_after, abs=1.5 * dt)


def test_hidden_frames_are_counted_until_the_target_is_back():
    trust = grown_up()
    for count in (1, 2, 3):
        trust.judge(GONE, 1 / 30)
        assert trust.hidden_frames == count
    trust.judge(GOOD, 1 / 30)
    assert trust.hidden_frames == 0


@pytest.mark.parametrize("hidden", [0.5, 30.0], ids=["coasting", "lost"])
@pytest.mark.parametrize(
    ("evidence", "back"),
    [
        (Evidence(0.2, 0.7, 0.1), False),  # too little is left of it
        (Evidence(1.0, 0.4, 0.1, moved=0.4), False),  # its colours are not back
        (Evidence(0.6, 0.8, 0.1), True),  # where it was, and nothing rivals it
        (Evidence(0.8, 0.8, 0.65, moved=1.0, away=1.0), False),  # anybody over there
        (Evidence(0.8, 0.8, 0.65, moved=0.5, away=1.0), True),
        (Evidence(0.6, 0.8, 0.6, moved=0.6, away=0.6, spread=0.2), False),
        (Evidence(1.0, 0.8, 0.1, moved=5.0, away=5.0), True),  # far, but nobody else
    ],
    ids=str,
)
def test_back_only_on_strong_evidence(hidden, evidence, back):
    trust = grown_up()
    while trust.hidden_frames * 0.1 < hidden:
        trust.judge(GONE, 0.1)
    away = State.LOST if hidden > LIMITS.lost_after else State.COASTING
    assert trust.state is away
    trust.judge(evidence, 0.1)
    assert trust.state is (State.TRACKING if back else away)


# In blur: less than ``hidden`` is left of shape and colours together, but it is recognised.
BLURRED = Evidence(0.55, 0.6, 0.5)


@pytest.mark.parametrize(
    ("evidence", "verdict"),
    [
        (BLURRED, Verdict.DOUBTED),  # where it must be
        (replace(BLURRED, moved=0.4), Verdict.HIDDEN),  # it would have to have jumped
        (replace(BLURRED, rival=0.9), Verdict.HIDDEN),  # another place looks as much like it
        (replace(BLURRED, template=0.3), Verdict.HIDDEN),  # hardly anything is left
    ],
    ids=str,
)
def test_who_is_known_in_its_place_is_not_hidden(evidence, verdict):
    assert grown_up().judge(evidence, 1 / 30) is verdict
    just_gone = grown_up()
    just_gone.judge(GONE, 1 / 30)
    assert just_gone.judge(evidence, 1 / 30) is verdict


@pytest.mark.parametrize("dt", [1 / 30, 1 / 15, 0.1])
def test_that_is_believed_for_half_a_second_only(dt):
    trust, followed = grown_up(dt=dt), 0.0
    while trust.judge(BLURRED, dt) is Verdict.DOUBTED:
        followed += dt
        assert followed < 0.5 + 2 * dt
    assert followed == pytest.approx(0.5, abs=1.5 * dt)
    for _ in range(10):
        assert trust.judge(BLURRED, dt) is Verdict.HIDDEN
    assert trust.judge(GOOD, dt) is not Verdict.HIDDEN


def test_weak_evidence_that_would_do_while_tracking_does_not_bring_it_back():
    weak = Evidence(0.7, 0.8, 0.6, moved=1.0, away=1.0)
    assert grown_up().judge(weak, 0.1) is not Verdict.HIDDEN
    trust = grown_up()
    trust.judge(GONE, 0.1)
    assert trust.judge(weak, 0.1) is Verdict.HIDDEN


@pytest.mark.parametrize(
    ("evidence", "back"),
    [
        (Evidence(0.95, 0.8, 0.2), True),
        (Evidence(0.75, 0.8, 0.2), False),  # half of it looks like all of it, but smaller
        (Evidence(0.95, 0.4, 0.2, moved=0.5), False),  # not its colours
    ],
    ids=str,
)
def test_back_at_another_size_only_as_a_whole(evidence, back):
    trust = grown_up()
    for _ in range(10):
        trust.judge(GONE, 0.1)
    assert trust.is_surely_back(evidence, other=GONE) is back


def test_who_had_a_twin_beside_is_not_a_confident_box_for_a_while():
    trust, scores = grown_up(), []
    trust.judge(Evidence(1.0, 0.8, 0.95), 0.1)
    for _ in range(20):
        trust.judge(GOOD, 0.1)
        scores.append(trust.score)
    assert max(scores[:10]) <= 0.5
    assert min(scores[13:]) > 0.5


def test_the_time_hidden_counts_from_the_last_sight():
    """Two absences that together are longer than lost_after do not make it LOST."""
    trust = grown_up()
    for evidence in [GONE] * 15 + [GOOD] + [GONE] * 15:
        trust.judge(evidence, 0.1)
        assert trust.state is not State.LOST


def test_hidden_frames_teach_nothing():
    """However long it was hidden, the measure of what is good stays the one before."""
    trust = grown_up()
    for _ in range(500):
        trust.judge(Evidence(0.3, 0.3, 0.25), 1 / 30)
    assert trust.state is State.LOST
    trust.judge(Evidence(0.4, 0.4, 0.25), 1 / 30)
    assert trust.state is State.LOST


def test_a_target_that_changes_slowly_stays_seen():
    trust = grown_up()
    for i in range(400):
        evidence = Evidence(1.0 - 0.001 * i, 0.8 - 0.001 * i, 0.2)
        assert trust.judge(evidence, 1 / 30) is Verdict.SEEN


def test_the_score_is_a_probability_that_rises_with_the_evidence():
    scores = []
    for template in (0.3, 0.5, 0.7, 0.9, 1.1):
        trust = grown_up()
        trust.judge(Evidence(template, 0.8, 0.1), 1 / 30)
        scores.append(trust.score)
    assert scores == sorted(scores)
    assert 0 <= scores[0] < scores[-1] <= 1


@pytest.mark.parametrize(("state", "most"), [(State.COASTING, 0.5), (State.LOST, 0.0)])
def test_what_is_not_seen_is_never_a_confident_box(state, most):
    trust = grown_up()
    # Good enough a shape to raise the score, not good enough to follow.
    for _ in range(100):
        trust.judge(Evidence(0.3, 0.8, 0.0), 0.1)
        if trust.state is state:
            assert trust.score <= most
    assert trust.state is State.LOST


@pytest.mark.parametrize("value", [20.0, -20.0, -1e4, 1e30, 1e-12, 0.0])
@pytest.mark.parametrize("frames", [0, 60])
def test_no_evidence_breaks_the_score(value, frames):
    trust = grown_up(frames=frames)
    trust.judge(Evidence(value, abs(value), value), 1 / 30)
    assert 0 <= trust.score <= 1
    assert math.isfinite(trust.score)


def test_without_colours_the_shape_alone_decides():
    """The vote of the colours may be switched off: their likelihood is then 0 in every frame."""
    trust = Trust(LIMITS)
    for _ in range(60):
        assert trust.judge(Evidence(1.0, 0.0, 0.1), 1 / 30) is Verdict.SEEN
    assert trust.judge(Evidence(0.1, 0.0, 0.1), 1 / 30) is Verdict.HIDDEN


@pytest.mark.parametrize(
    ("found", "known", "surely"),
    [
        (Evidence(0.95, 0.8, 0.2), GONE, True),
        (Evidence(0.95, 0.8, 0.2), Evidence(1.0, 0.8, 0.1), False),  # better at the known size
        (Evidence(0.75, 0.64, 0.75, spread=0.1), GONE, False),  # enough at the known size only
        (Evidence(0.95, 0.3, 0.2), GONE, False),  # other colours
    ],
    ids=str,
)
def test_another_size_needs_stronger_evidence(found, known, surely):
    trust = grown_up()
    for _ in range(30):
        trust.judge(GONE, 1 / 30)
    assert trust.is_surely_back(found, known) is surely
    assert trust.hidden_for == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("evidence", "in_the_end"),
    [
        (Evidence(0.65, 0.5, 0.3), Verdict.SEEN),  # other light, for good
        (Evidence(0.75, 0.6, 0.3), Verdict.SEEN),
        (Evidence(0.7, 0.8, 0.88), Verdict.HIDDEN),  # one of two, nobody knows which
    ],
    ids=str,
)
def test_a_doubt_that_lasts_ends(evidence, in_the_end):
    trust = grown_up()
    verdicts = [trust.judge(evidence, 0.1) for _ in range(7)]
    assert verdicts[:4] == [Verdict.DOUBTED] * 4
    assert verdicts[-1] is in_the_end


def test_light_that_changed_for_good_is_the_light_in_the_end():
    trust = grown_up()
    verdicts = [trust.judge(Evidence(0.8, 0.55, 0.2), 1 / 30) for _ in range(200)]
    assert trust.state is State.TRACKING
    assert Verdict.HIDDEN not in verdicts
    assert verdicts[-20:] == [Verdict.SEEN] * 20


@pytest.mark.parametrize(
    ("moved", "hidden", "sure"), [(0.3, 20, True), (1.0, 20, False), (1.0, 3, True)]
)
def test_who_comes_back_far_off_is_not_a_confident_box_for_a_while(moved, hidden, sure):
    """Somebody in the same clothes may have come out elsewhere."""
    trust = grown_up()
    for _ in range(hidden):
        trust.judge(GONE, 1 / 30)
    trust.judge(replace(GOOD, moved=moved), 1 / 30)
    assert trust.state is State.TRACKING
    scores = [trust.score]
    for _ in range(60):
        trust.judge(GOOD, 1 / 30)
        scores.append(trust.score)
    assert (min(scores[:30]) > 0.5) is sure
    assert min(scores[40:]) > 0.5


UNSURE = Evidence(template=0.75, colour=0.7, rival=0.6, moved=0.5, away=0.5)


def hidden_for(frames):
    trust = grown_up()
    for _ in range(frames):
        trust.judge(GONE, 0.05)
    return trust


@pytest.mark.parametrize(
    ("back", "verdict"),
    [
        (UNSURE, Verdict.DOUBTED),  # the post that hid the target may look a little like it
        (replace(UNSURE, template=0.9), Verdict.SEEN),  # as much like it as before
        (Evidence(**BACK), Verdict.SEEN),  # recognised for sure
    ],
    ids=str,
)
def test_who_is_back_but_not_for_sure_is_neither_learnt_nor_confident_at_once(back, verdict):
    trust = hidden_for(10)
    for _ in range(2):
        assert trust.judge(back, 0.05) is verdict
        assert (trust.score > 0.5) is (verdict is Verdict.SEEN)
        assert trust.state is State.TRACKING


def test_after_a_moment_who_is_back_is_learnt_as_it_is():
    trust = hidden_for(10)
    trust.judge(UNSURE, 0.05)
    later = Evidence(template=0.8, colour=0.7, rival=0.3)
    verdicts, scores = [], []
    for _ in range(40):
        verdicts.append(trust.judge(later, 0.05))
        scores.append(trust.score)
    assert verdicts[:5] == [Verdict.DOUBTED] * 5
    assert verdicts[-20:] == [Verdict.SEEN] * 20
    assert max(scores[:5]) <= 0.5 < min(scores[-20:])


def test_a_frame_or_two_away_is_no_return():
    trust = hidden_for(3)
    assert trust.judge(UNSURE, 0.05) is Verdict.SEEN
