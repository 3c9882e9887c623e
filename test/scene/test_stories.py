# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros import Box
from het_ros.scene import STORIES, Scene, SceneConfig

HIDES = [("hidden_500ms", 0.5), ("hidden_1s", 1.0), ("hidden_2s", 2.0), ("lookalike_at_column", 1)]


@pytest.mark.parametrize("story", STORIES)
def test_every_story_begins_with_a_whole_target_worth_following(tell, story):
    scene = tell(story)
    frame = scene.frame(0)
    assert frame.visible > 0.98
    assert frame.box.h > 80
    inside = frame.box.intersection(Box(0, 0, scene.lens.width, scene.lens.height))
    assert inside == pytest.approx(frame.box.area)
    assert frame.image.std() > 35  # a scene, not a blank


@pytest.mark.parametrize(("story", "seconds"), HIDES)
@pytest.mark.parametrize("seed", [0, 1])
def test_a_column_hides_the_target_once_for_so_long(tell, story, seconds, seed):
    scene = tell(story, seed)
    ((first, last),) = scene.hidden_ranges()
    assert (last - first) / scene.config.rate == pytest.approx(seconds, abs=0.3)
    visible = scene.visibility
    assert visible[: first - 10].min() > 0.99
    assert visible[last + 10 :].min() > 0.99


@pytest.mark.parametrize("story", ["plain_walk", "light_change", "approaching"])
def test_nothing_hides_the_target(tell, story):
    assert tell(story).visibility.min() > 0.98


def test_the_target_leaves_and_returns(tell):
    scene = tell("leaves_and_returns")
    ((first, last),) = scene.hidden_ranges()
    assert 1.0 < (last - first) / scene.config.rate < 4.0
    assert scene.frame(len(scene) - 1).visible > 0.98


def test_the_lookalike_passes_in_front_without_hiding_all(tell):
    scene = tell("lookalike_crosses")
    nearest = int(scene.visibility.argmin())
    assert 0.02 < scene.visibility[nearest] < 0.9
    crossing = scene.frame(nearest)
    (other,) = crossing.others
    assert other.h > crossing.box.h
    assert other.iou(crossing.box) > 0.2
    assert scene.frame(len(scene) - 1).others == ()


def test_the_cloud_takes_half_of_the_light(tell):
    scene = tell("light_change")
    sunny, cloudy = scene.render(1.0).image.mean(), scene.render(4.5).image.mean()
    assert cloudy < 0.55 * sunny


def test_the_target_grows(tell):
    scene = tell("approaching")
    heights = [scene.frame(k).box.h for k in range(0, len(scene), 8)]
    assert max(heights) > 2 * min(heights)


def test_the_shipped_story_has_it_all(tell):
    scene = tell("follow_walk")
    visible = scene.visibility
    ((first, last),) = scene.hidden_ranges()
    assert 0.9 < (last - first) / scene.config.rate < 1.4
    assert visible[last + 50 :].min() < 0.8  # somebody crosses in front
    heights = [scene.frame(k).box.h for k in range(0, len(scene), 10)]
    assert max(heights) > 1.5 * min(heights)


def test_seeds_tell_a_story_differently():
    walks = [Scene(SceneConfig(story="plain_walk", seed=seed)).story.target for seed in range(3)]
    assert len(set(walks)) == 3
    assert not np.allclose(walks[0], walks[1])
