# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.evaluation import honesty
from het_ros.evaluation.runs import Run

from .test_state_metrics import AWAY, HERE, NAN, pair

HALF = (10, 15, 10, 10)  # overlap 1/3 with HERE


def test_a_run_frame_by_frame():
    #         given  right  right  off   absent  lost   unsure and off
    truth = [HERE, HERE, HERE, HERE, NAN, HERE, HERE]
    boxes = [HERE, HERE, HERE, AWAY, HERE, HERE, AWAY]
    scores = [1.0, 0.9, 0.4, 0.8, 0.7, 0.2, 0.1]
    run, true = pair("TTTTTLC", boxes=boxes, truth=truth, scores=scores)
    found = honesty.of_run(run, true)
    assert found["confident"] == pytest.approx(3 / 6)
    assert found["confident_off"] == pytest.approx(2 / 3)
    assert found["off"] == pytest.approx(2 / 6)
    assert found["recall"] == pytest.approx(3 / 5)
    assert found["longest_false_lost"] == 1
    # Of five visible frames two have a published box on the target: 20 of 21 thresholds each.
    assert found["published_auc"] == pytest.approx(2 / 5 * 20 / 21)


def test_a_box_that_touches_is_not_off():
    run, truth = pair("TT", boxes=[HERE, HALF], scores=[1.0, 0.9])
    assert honesty.of_run(run, truth)["off"] == 0


def test_without_states_a_confident_frame_is_said_to_be_visible():
    run, truth = pair(boxes=[HERE] * 4, scores=[1.0, 0.9, 0.3, 0.6])
    assert honesty.of_run(run, truth)["recall"] == pytest.approx(2 / 3)


def test_who_is_never_confident_is_never_wrongly_so():
    run, truth = pair("TT", boxes=[HERE, AWAY], scores=[1.0, 0.2])
    found = honesty.of_run(run, truth)
    assert (found["confident_off"], found["off"]) == (None, 0)


def slow_long_term(run, truth, threshold):
    """Frame by frame, for one sequence."""
    shared, predicted, visible = 0.0, 0, 0
    for row in range(1, len(truth)):
        seen = not np.isnan(truth[row]).any()
        visible += seen
        if run.track.states[row] == "LOST" or not run.track.scores[row] >= threshold:
            continue
        predicted += 1
        if seen:
            (x, y, w, h), (a, b, c, d) = run.track.boxes[row], truth[row]
            across = max(min(x + w, a + c) - max(x, a), 0) * max(min(y + h, b + d) - max(y, b), 0)
            shared += across / (w * h + c * d - across)
    return shared / predicted if predicted else 1.0, shared / visible


def test_long_term_measures_against_slow_code():
    draw = np.random.default_rng(0)
    pairs = []
    for name in ("a", "b"):
        truth = np.array([HERE if draw.random() < 0.8 else NAN for _ in range(40)], float)
        truth[0] = HERE
        boxes = np.array([HERE] * 40, float) + np.c_[draw.normal(0, 6, (40, 2)), np.zeros((40, 2))]
        states = "".join(draw.choice(list("TTTCL"), 40))
        run, true = pair(
            states, boxes=list(boxes), truth=list(truth), scores=list(draw.random(40))
        )
        pairs.append((Run("x", name, 0, "ope", run.rows, run.track), true))
    found = honesty.long_term(pairs)
    best = (0.0, 0.0, 0.0, 0.0)
    for level in sorted(score for run, _ in pairs for score in run.track.scores[1:]):
        both = np.mean([slow_long_term(run, truth, level) for run, truth in pairs], axis=0)
        f = 2 * both[0] * both[1] / both.sum() if both.sum() else 0.0
        best = max(best, (f, *both, level), key=lambda one: one[0])
    assert [found[k] for k in ("f", "precision", "recall", "threshold")] == pytest.approx(best)


def test_a_score_that_tells_right_from_wrong_finds_its_threshold():
    run, truth = pair(boxes=[HERE] * 5 + [AWAY] * 5, scores=[1.0] + [0.8] * 4 + [0.3] * 5)
    found = honesty.long_term([(run, truth)])
    assert found["threshold"] == pytest.approx(0.8)
    assert (found["precision"], found["recall"]) == (1.0, pytest.approx(4 / 9))


def test_seeds_are_averaged_and_the_longest_loss_is_the_longest_of_all():
    (good, truth), (bad, _) = (
        pair(states, boxes=[HERE] * 5, scores=[0.9] * 5) for states in ("TTTTT", "TLLLT")
    )
    found = honesty.summarise([good, bad], {"s": truth})["honesty"]
    assert found["sequences"]["s"]["recall"] == pytest.approx((1 + 1 / 4) / 2)
    assert found["longest_false_lost"] == 3


def test_without_a_score_nothing_is_said():
    run, truth = pair("TTT")
    assert honesty.summarise([run], {"s": truth}) == {}
