# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import numpy as np
import pytest

from het_ros import TrackerConfig
from het_ros.tracking.appearance import Appearance
from het_ros.tracking.layers import grid
from het_ros.tracking.sub_patches import draw_sub_patches
from het_ros.tracking.view import View

WEIGHTED = {"combination": "weighted", "trust": False}
NAIVE = {**WEIGHTED, "base_ensemble": "naive_bayes"}
CONFIGS = [{}, {"colour_weight": 0.0}, {"flow_weight": 0.0}, WEIGHTED, NAIVE]


def learnt(frames, changes):
    """(appearance, view, image, box) of a target learnt in the first frame."""
    config = replace(TrackerConfig(), **changes)
    image, box = frames.image(0), frames.boxes[0]
    cells, unit = grid(config, box)
    rng = np.random.default_rng(0)
    patches = draw_sub_patches(cells, config.sub_patches, config.sub_patch_fraction, rng)
    view = View(config, image, box, cells, unit, patches.size, rng)
    appearance = Appearance(config, cells, patches, view)
    centre = np.array(box.centre)
    frame = view.look(image, centre, 1.0)
    everyone = np.ones(config.sub_patches, bool)
    appearance.learn(frame, appearance.corner_in(frame.window, centre), everyone)
    return appearance, view, image, box


@pytest.mark.parametrize("changes", CONFIGS, ids=str)
@pytest.mark.parametrize("name", ["David", "Crossing"])
def test_who_was_learnt_is_found_beside_the_middle_of_the_window(sequence, name, changes):
    appearance, view, image, box = learnt(sequence(name), changes)
    centre, side = np.array(box.centre), np.sqrt(box.area)
    expected = centre + side * np.array([0.3, -0.2])
    frame = view.look(image, expected, 1.0)
    found = appearance.find(frame, expected, centre, side)
    place = appearance.centre_in(frame.window, found.corner)
    np.testing.assert_allclose(place, centre, atol=0.06 * side)
    if found.evidence:
        assert found.evidence.moved == pytest.approx(np.hypot(0.3, 0.2), abs=0.06)
        assert found.evidence.away < 0.06
        assert found.evidence.template > 0.7


@pytest.mark.parametrize(("changes", "known"), [({}, True), ({"first_look": False}, False)])
def test_the_first_frame_is_known_again(sequence, changes, known):
    appearance, view, image, box = learnt(sequence("David"), changes)
    centre, side = np.array(box.centre), np.sqrt(box.area)
    frame = view.look(image, centre, 1.0)
    found = appearance.find(frame, centre, centre, side)
    if known:
        assert found.evidence.likeness > 0.9
        assert found.ratio == pytest.approx(1.0, abs=0.01)
    else:
        assert found.evidence.likeness is None
        assert found.ratio == 1.0


def test_a_corner_and_its_centre_belong_together(sequence):
    appearance, view, image, box = learnt(sequence("David"), {})
    window = view.look(image, np.array(box.centre), 1.0).window
    place = np.array([100.0, 80.0])
    corner = appearance.corner_in(window, place)
    np.testing.assert_allclose(appearance.centre_in(window, corner), place)


@pytest.mark.parametrize("changes", [WEIGHTED, NAIVE], ids=str)
def test_the_score_falls_beside_the_target(sequence, changes):
    appearance, view, image, box = learnt(sequence("David"), changes)
    centre, side = np.array(box.centre), np.sqrt(box.area)
    frame = view.look(image, centre, 1.0)
    found = appearance.find(frame, centre, centre, side)
    scores = []
    for shift in (0.0, 0.4):
        corner = appearance.corner_in(frame.window, centre + side * np.array([shift, 0.0]))
        score, chosen = appearance.score_at(frame, found, corner)
        assert chosen.shape == (TrackerConfig().sub_patches,)
        scores.append(score)
    assert scores[0] > scores[1] + 0.2


def test_linear_base_ensembles_have_a_template_and_others_none(sequence):
    for changes, has in (({}, True), (NAIVE, False)):
        appearance, view, image, box = learnt(sequence("David"), changes)
        frame = view.look(image, np.array(box.centre), 1.0)
        assert (appearance.template(frame) is not None) is has
