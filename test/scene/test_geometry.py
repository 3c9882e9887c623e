# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.scene.camera import CameraState, Lens, plane_to_image, project
from het_ros.scene.gait import BONES, joints
from het_ros.scene.path import Path

LENS = Lens.wide(640, 480)
CAMERA = CameraState(x=0.4, z=-0.3, yaw=0.3, pitch=0.02)


def test_the_camera_matrix_projects_as_project_does():
    point = np.array([0.7, 1.9, 6.0])
    still = CameraState(height=1.1)
    u, v, w = LENS.matrix @ np.array([0.7, 1.1 - 1.9, 6.0])
    assert project(point, still, LENS) == pytest.approx([u / w, v / w, 6.0])


def test_a_plane_lands_where_its_points_do():
    origin, along, down = np.array([-2.0, 0, 9]), np.array([0.05, 0, 0]), np.array([0, 0, -0.05])
    plane = plane_to_image(origin, along, down, CAMERA, LENS)
    for texel in ((0, 0), (60, 10), (90, 80)):
        u, v, w = plane @ (*texel, 1)
        expected = project(origin + texel[0] * along + texel[1] * down, CAMERA, LENS)
        assert (u / w, v / w, w) == pytest.approx(tuple(expected))


@pytest.mark.parametrize("phase", np.linspace(0, 2 * np.pi, 9))
def test_a_walking_body_keeps_its_bones_and_stands_on_the_ground(phase):
    body = joints(phase, 1.0, 1.8, np.array([1.0, 0, 0]), np.array([3.0, 0, 5.0]))
    for side in ("left", "right"):
        thigh = np.linalg.norm(body[f"{side}_hip"] - body[f"{side}_knee"])
        shank = np.linalg.norm(body[f"{side}_knee"] - body[f"{side}_ankle"])
        assert (thigh, shank) == pytest.approx((1.8 * BONES["thigh"], 1.8 * BONES["shank"]))
    lowest = min(point[1] for point in body.values())
    assert 0 <= lowest < 0.03
    assert 1.5 < body["head"][1] < 1.8


def test_the_left_leg_leads_at_phase_zero():
    body = joints(0.0, 1.0, 1.8, np.array([0, 0, 1.0]), np.zeros(3))
    assert body["left_ankle"][2] > body["right_ankle"][2] + 0.4
    assert body["left_hip"][0] < body["right_hip"][0]  # seen from above, looking along z


def test_a_path_passes_its_waypoints_at_their_speed():
    path = Path([(0, 0, 5), (4, 4, 5), (8, 4, 9)])
    x, z, heading, walked, speed = path.at(2.0)
    assert (x, z, heading, speed) == pytest.approx((2, 5, np.pi / 2, 1), abs=0.02)
    assert path.at(6.0)[2] == pytest.approx(0, abs=0.02)
    assert path.at(6.0)[3] - walked == pytest.approx(4, abs=0.25)
    assert path.at(99.0)[4] == 0


def test_waypoints_out_of_order_are_refused():
    with pytest.raises(ValueError, match="growing"):
        Path([(1, 0, 0), (0, 1, 0)])
