# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The truth against the pixels: what changes when only the target's clothes change."""

import dataclasses

import numpy as np
import pytest

from het_ros import Box
from het_ros.scene import Scene, SceneConfig
from het_ros.scene.clothes import Outfit, outfit

SEED = 5


def _painted(tone: float) -> Outfit:
    """Clothes and skin of one grey, on the body that any scene of this test shares."""
    body = outfit(np.random.default_rng(1))
    parts = {
        name: dataclasses.replace(part, texture=np.full_like(part.texture, tone))
        for name, part in body.parts.items()
    }
    return Outfit(body.height, parts)


class Pixels:
    """Where two renderings of a story, with a black and a white target, differ."""

    def __init__(self, story: str, **changes: object) -> None:
        config = SceneConfig(story=story, seed=SEED, noise=0.0)
        plot = dataclasses.replace(Scene(config).story, passers=(), **changes)
        self.scene, self.white = (Scene(config, plot, _painted(tone)) for tone in (0, 255))

    def silhouette(self, index: int) -> np.ndarray:
        black, white = (s.frame(index).image.astype(int) for s in (self.scene, self.white))
        return (white - black).max(axis=2) > 60


def _bounds(mask: np.ndarray) -> Box:
    columns, rows = np.flatnonzero(mask.any(axis=0)), np.flatnonzero(mask.any(axis=1))
    return Box(columns[0], rows[0], np.ptp(columns) + 1, np.ptp(rows) + 1)


@pytest.fixture(scope="module")
def behind_column():
    return Pixels("hidden_1s")


@pytest.fixture(scope="module")
def in_the_open():
    return Pixels("hidden_1s", columns=())


@pytest.mark.parametrize("index", [0, 17, 31, 60, 150])
def test_the_box_is_the_tight_box_of_the_pixels(in_the_open, index):
    seen, box = _bounds(in_the_open.silhouette(index)), in_the_open.scene.frame(index).box
    assert np.allclose(box.as_tuple(), seen.as_tuple(), atol=2.0)
    assert np.allclose(box.centre, seen.centre, atol=1.0)


def test_the_mask_is_where_the_pixels_are(in_the_open):
    mask = in_the_open.scene.frame(40).mask > 0
    pixels = in_the_open.silhouette(40)
    assert (mask & pixels).sum() > 0.95 * (mask | pixels).sum()


def test_visible_is_the_part_of_the_pixels_that_is_left(behind_column, in_the_open):
    visible = behind_column.scene.visibility
    partly = np.flatnonzero((visible > 0.15) & (visible < 0.9))
    assert len(partly) >= 3
    for index in partly:
        left, whole = (p.silhouette(index).sum() for p in (behind_column, in_the_open))
        assert visible[index] == pytest.approx(left / whole, abs=0.04)


def test_a_hidden_target_leaves_no_trace(behind_column):
    first, last = behind_column.scene.hidden_ranges()[0]
    middle = (first + last) // 2
    assert not behind_column.silhouette(middle).any()
    frame = behind_column.scene.frame(middle)
    assert frame.visible == 0
    assert not frame.mask.any()


def test_a_box_at_the_edge_goes_on_outside(tell):
    scene = tell("leaves_and_returns")
    visible = scene.visibility
    leaving = int(np.flatnonzero((visible > 0.1) & (visible < 0.9))[0])
    frame = scene.frame(leaving)
    assert frame.box.x + frame.box.w > scene.lens.width
    gone = scene.frame(scene.hidden_ranges(below=0.001)[0][0] + 3)
    assert not gone.box.touches_image(scene.lens.width, scene.lens.height)
