# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.scene import Scene, SceneConfig
from het_ros.scene.camera import CameraState, project
from het_ros.scene.motion import MIDDLE, image_motion


@pytest.mark.parametrize("story", ["plain_walk", "leaves_and_returns", "approaching"])
def test_both_parts_together_are_how_the_target_moves_in_the_image(story):
    """Against the way of the very point that stands for the target, camera and all."""
    scene = Scene(SceneConfig(story=story, seed=3))
    for t in (1.0, 2.5, 4.0):
        places = []
        for moment in (t - 0.01, t + 0.01):
            x, z = scene.target_at(moment)
            point = np.array([x, MIDDLE, z])
            places.append(project(point, scene.camera_at(moment), scene.lens)[:2])
        motion = image_motion(scene, t)
        whole = np.array(motion.own) + motion.camera
        np.testing.assert_allclose(whole, (places[1] - places[0]) / 0.02, atol=0.5)


def test_it_is_how_the_silhouette_moves_but_for_its_limbs():
    scene = Scene(SceneConfig(story="leaves_and_returns", seed=1, width=320, height=240))
    centres = np.array([scene.frame(i).box.centre for i in range(10, 41)])
    seconds = 30 / scene.config.rate
    moved = [image_motion(scene, i / scene.config.rate) for i in range(10, 41)]
    whole = np.array([np.array(m.own) + m.camera for m in moved])
    mean = (whole[1:] + whole[:-1]).mean(axis=0) / 2
    np.testing.assert_allclose(mean, (centres[-1] - centres[0]) / seconds, atol=3)


def test_a_camera_that_stands_still_adds_nothing(monkeypatch):
    scene = Scene(SceneConfig(story="leaves_and_returns", seed=2))
    monkeypatch.setattr(scene, "camera_at", lambda t: CameraState())
    motion = image_motion(scene, 1.0)
    assert motion.camera == (0, 0)
    assert abs(motion.own[0]) > 20


def test_a_target_that_stands_still_has_no_motion_of_its_own(monkeypatch):
    """A camera that turns right moves the image left, f times its rate where it looks."""
    scene = Scene(SceneConfig(seed=2))
    monkeypatch.setattr(scene, "target_at", lambda t: (0.0, 5.0))
    monkeypatch.setattr(scene, "camera_at", lambda t: CameraState(yaw=0.3 * (t - 1)))
    motion = image_motion(scene, 1.0)
    assert motion.own == (0, 0)
    assert motion.camera[0] == pytest.approx(-0.3 * scene.lens.focal, rel=1e-3)


def test_there_is_none_behind_the_camera(monkeypatch):
    scene = Scene(SceneConfig(seed=2))
    monkeypatch.setattr(scene, "target_at", lambda t: (0.0, -5.0))
    monkeypatch.setattr(scene, "camera_at", lambda t: CameraState())
    assert image_motion(scene, 1.0) is None
