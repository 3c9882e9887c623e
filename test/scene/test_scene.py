# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import dataclasses

import numpy as np
import pytest

from het_ros.scene import CameraState, Scene, SceneConfig

SMALL = SceneConfig(story="plain_walk", seed=4, width=320, height=240, seconds=2.0)


@pytest.fixture(scope="module")
def scene():
    return Scene(SMALL)


def test_the_same_configuration_gives_the_same_pixels_and_truth(scene):
    again = Scene(SMALL)
    for index in (0, 7, 39):
        one, other = scene.frame(index), again.frame(index)
        assert np.array_equal(one.image, other.image)
        assert (one.box, one.visible, one.stamp) == (other.box, other.visible, other.stamp)


def test_frames_do_not_depend_on_what_was_rendered_before(scene):
    in_order = list(scene.frames())
    assert len(in_order) == len(scene) == 40
    for index in (33, 2):
        assert np.array_equal(scene.frame(index).image, in_order[index].image)


def test_frames_are_lazy_and_stamped(scene):
    frames = scene.frames()
    assert [next(frames).stamp for _ in range(3)] == pytest.approx([0, 0.05, 0.1])


@pytest.mark.parametrize("change", [{"seed": 5}, {"noise": 0.0}, {"shake": 0.0}])
def test_what_a_scene_depends_on_changes_it(scene, change):
    other = Scene(dataclasses.replace(SMALL, **change))
    assert not np.array_equal(scene.frame(9).image, other.frame(9).image)


def test_noise_has_the_deviation_that_was_asked_for():
    clean, noisy = (
        Scene(dataclasses.replace(SMALL, noise=noise)).frame(5).image.astype(int)
        for noise in (0.0, 4.0)
    )
    assert (noisy - clean).std() == pytest.approx(4.0, rel=0.15)


def test_the_shutter_smears_a_panning_camera():
    scene = Scene(dataclasses.replace(SMALL, noise=0.0))
    still = scene.camera_at(1.0)
    sharp, smeared = (
        scene.render(1.0, dataclasses.replace(still, yaw_rate=rate)).image.astype(float)
        for rate in (0.0, 3.0)
    )
    across = [np.abs(np.diff(image, axis=1)).mean() for image in (sharp, smeared)]
    assert across[1] < 0.75 * across[0]


@pytest.mark.parametrize("yaw", [-2.5, -0.6, 0.0, 0.4, 1.5])
def test_a_steered_camera_sees_the_target_where_it_points(scene, yaw):
    x, z = scene.target_at(1.0)
    camera = CameraState(x=x - 4 * np.sin(yaw), z=z - 4 * np.cos(yaw), yaw=yaw)
    frame = scene.render(1.0, camera)
    assert frame.box.centre[0] == pytest.approx(scene.lens.width / 2, abs=0.1 * frame.box.h)
    assert frame.visible > 0.5
    assert frame.camera == camera


def test_a_camera_that_looks_away_has_no_box(scene):
    frame = scene.render(1.0, CameraState(yaw=np.pi))
    assert frame.box is None
    assert frame.visible == 0
    assert frame.image.std() > 10  # there is still a world


@pytest.mark.parametrize(
    ("wrong", "names"),
    [({"story": "romance"}, "plain_walk"), ({"rate": 0.0}, "rate"), ({"width": 8}, "width")],
)
def test_a_wrong_configuration_is_refused(wrong, names):
    with pytest.raises(ValueError, match=names):
        SceneConfig(**wrong)


def test_a_robot_that_turns_to_the_target_keeps_it_through_an_occlusion():
    """The closed loop: what the last frame showed steers the camera of the next."""
    scene = Scene(SceneConfig(story="patrol", seed=2, width=160, height=120))
    camera, turn, visible = CameraState(yaw=-0.4), 0.0, []
    for step in range(220):
        frame = scene.render(step / 10, camera)
        visible.append(frame.visible)
        turn *= 0.9
        if frame.visible > 0.2:
            off = frame.box.centre[0] - scene.lens.width / 2
            turn = 2 * np.arctan2(off, scene.lens.focal)
        camera = dataclasses.replace(camera, yaw=camera.yaw + turn / 10, yaw_rate=turn)
    assert min(visible) < 0.02  # the column did hide it
    assert np.mean(np.array(visible) > 0.2) > 0.85
    assert np.mean(visible[-20:]) > 0.95
