# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The paper's tracker against a slow and obvious one, frame by frame."""

import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.features.channels import names_for
from het_ros.tracking.features.compressive import draw_measurement_matrix
from het_ros.tracking.paper import target
from het_ros.tracking.paper.appearance import draw_sub_patches
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.paper.tracker import PaperTracker

from . import reference

RELATIVE = 1e-6
DT = 1 / 30


def small_config(seed):
    """The paper's, but for what makes the reference take minutes."""
    return PaperConfig(seed=seed, features=12, sub_patches=4, search_radius=9.0)


def reference_tracker(config, image, box):
    """A reference with the sub-patches and the matrix that the tracker draws."""
    rng = np.random.default_rng(config.seed)
    patches = draw_sub_patches((box.w, box.h), config.sub_patches, config.sub_patch_fraction, rng)
    names = names_for(config.channels, image.ndim == 2)
    matrix = draw_measurement_matrix(
        patches.size, len(names), config.features, config.rectangles, rng
    )
    offsets = [tuple(offset) for offset in patches.offsets]
    slow = reference.Tracker(config, names, patches.size, offsets, matrix.rows)
    slow.init(image, box.as_tuple())
    return slow


@pytest.fixture
def seen(monkeypatch):
    """What the tracker's layers handed each other in the last frame."""
    last = {}
    score_maps, detect = target.score_maps, target.detect
    weights, select = target.weights, target.to_be_updated

    def keep(name, value):
        last[name] = value
        return value

    def keep_scores(classifiers, features, scratch):
        last["features"] = features
        return keep("scores", score_maps(classifiers, features, scratch))

    monkeypatch.setattr(target, "score_maps", keep_scores)
    monkeypatch.setattr(target, "detect", lambda *a: keep("found", detect(*a)))
    monkeypatch.setattr(target, "weights", lambda *a: keep("omega", weights(*a)))
    monkeypatch.setattr(target, "to_be_updated", lambda c: keep("chosen", select(c)))
    return last


def assert_same_frame(slow, seen):
    """Features and scores to 1e-6, the same argmax, the same weights and choice."""
    _, rows, columns = seen["features"].shape
    features = np.array(
        [[slow.features[x, y] for x in range(columns)] for y in range(rows)]
    ).transpose(2, 0, 1)
    np.testing.assert_allclose(seen["features"], features, rtol=RELATIVE, atol=1e-12)
    for fast, places in zip(seen["scores"], slow.scores, strict=True):
        assert len(places) > 200
        here = np.array([fast[y, x] for x, y in places])
        np.testing.assert_allclose(here, list(places.values()), rtol=RELATIVE, atol=1e-9)
    assert [tuple(corner) for corner in seen["found"].corners] == slow.places
    np.testing.assert_allclose(seen["omega"], slow.omega, rtol=RELATIVE)
    assert seen["chosen"].tolist() == slow.chosen


def assert_same_track(images, box, config, seen):
    fast = PaperTracker(config)
    fast.init(images[0], box)
    slow = reference_tracker(config, images[0], box)
    for image in images[1:]:
        estimate = fast.update(image, DT)
        slow.update(image, DT)
        assert_same_frame(slow, seen)
        np.testing.assert_allclose(estimate.box.centre, slow.motion.x[:2], rtol=RELATIVE)
        assert estimate.score == pytest.approx(slow.likelihood, rel=RELATIVE)
        np.testing.assert_allclose(estimate.velocity, slow.motion.x[2:], rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(estimate.covariance, slow.motion.p, rtol=1e-5, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "start", "seed"),
    [("Crossing", 60, 1), ("David", 0, 2)],
)
def test_real_frames(sequence, seen, name, start, seed):
    frames = sequence(name)
    images = [frames.image(start + i) for i in range(3)]
    assert_same_track(images, frames.boxes[start], small_config(seed), seen)


def test_gray_frames(sequence, seen):
    frames = sequence("Crossing")
    images = [np.ascontiguousarray(frames.image(i)[:, :, 1]) for i in range(3)]
    assert_same_track(images, frames.boxes[0], small_config(4), seen)


@pytest.mark.parametrize(
    "box",
    [
        Box(60, 40, 20, 30),
        Box(61.3, 40.7, 17.5, 22.2),  # between the pixels
        Box(-9, 100, 20, 30),  # over two borders
        Box(70, 50, 4, 4),
    ],
    ids=str,
)
def test_moving_noise(noise, seen, box):
    images = [np.roll(noise, (2 * i, 3 * i), axis=(0, 1)) for i in range(3)]
    assert_same_track(images, box, small_config(0), seen)


def test_with_the_papers_constants_but_fewer_features(sequence, seen):
    frames = sequence("Crossing")
    images = [frames.image(i) for i in range(2)]
    assert_same_track(images, frames.boxes[0], PaperConfig(features=15), seen)
