# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import cv2
import numpy as np
import pytest
from test_angle_filter import CENTRE, SIZE, picture, turned

from het_ros import Box, HierarchicalEnsembleTracker, TrackerConfig
from het_ros.tracking.rotation import Rotation

DT = 1 / 30


def followed(degrees):
    """(n,) degrees of the windows while a picture is turned by ``degrees`` (n,)."""
    rotation, image = Rotation(*SIZE), picture()
    rotation.learn(image, CENTRE)
    angles = []
    for angle in degrees:
        rotation.predict(DT)
        angles.append(np.degrees(rotation.angle))
        window = turned(image, angle - angles[-1])
        rotation.observe(window, CENTRE, DT)
        rotation.learn(window, CENTRE)
    return np.array(angles), rotation


def swing(amplitude, frames=180, period=90):
    return amplitude * np.sin(2 * np.pi * np.arange(frames) / period)


def test_a_picture_that_rolls_is_followed():
    degrees = swing(40)
    angles, _ = followed(degrees)
    clearly = (np.abs(degrees) > 20) & (np.arange(len(degrees)) > 15)
    assert np.median(np.abs(angles - degrees)[clearly]) < 6
    assert (np.sign(angles) == np.sign(degrees))[clearly].mean() > 0.9


def test_a_picture_that_turns_over_and_over_is_followed():
    """60 degrees/s: behind, but never lost."""
    degrees = np.concatenate([np.zeros(20), 2.0 * np.arange(240)])
    angles, _ = followed(degrees)
    behind = np.remainder(angles - degrees + 180, 360) - 180
    assert np.abs(behind[60:]).max() < 30


@pytest.mark.parametrize("amplitude", [0, 5, 10])
def test_what_sways_a_little_is_not_turned(amplitude):
    angles, _ = followed(swing(amplitude))
    np.testing.assert_array_equal(angles, 0)


def test_what_turned_back_is_upright_again():
    angles, _ = followed(np.concatenate([swing(40, 45), np.zeros(60)]))
    assert np.abs(angles).max() > 20
    np.testing.assert_array_equal(angles[-20:], 0)


def test_a_hidden_target_turns_back():
    _, rotation = followed(np.linspace(0, 60, 60))
    assert np.degrees(rotation.angle) > 40
    for _ in range(150):
        rotation.predict(DT)
        rotation.coast()
    assert rotation.angle == 0


def test_stamps_in_a_burst_make_no_spin():
    """A frame a microsecond after the last one, and one that comes late."""
    rotation, image = Rotation(*SIZE), picture()
    rotation.learn(image, CENTRE)
    for dt in [DT] * 20 + [1e-6] * 3 + [0.5]:
        rotation.predict(dt)
        rotation.observe(turned(image, 6), CENTRE, dt)
        rotation.learn(turned(image, 6), CENTRE)
    assert rotation.angle == 0


def rolled(image, degrees):
    height, width = image.shape[:2]
    matrix = cv2.getRotationMatrix2D((width / 2, height / 2), degrees, 1.0)
    return cv2.warpAffine(image, matrix, (width, height)), matrix


@pytest.mark.parametrize("name", ["David", "Human7"])
def test_a_camera_that_rolls_by_40_degrees(sequence, name):
    """Real frames turned to and fro in 3 s: boxes turn with what they follow."""
    frames = sequence(name)

    def overlap(config):
        """Mean over 120 frames with the true boxes, turned."""
        tracker = HierarchicalEnsembleTracker(config)
        tracker.init(frames.image(0), frames.boxes[0])
        shared = []
        for index, degrees in list(enumerate(swing(40, 120)))[1:]:
            image, matrix = rolled(frames.image(index), degrees)
            box = frames.boxes[index]
            true = Box.from_centre(*(matrix @ (*box.centre, 1)), box.w, box.h)
            found = tracker.update(image, DT).box
            shared.append(found.iou(true.turned(np.radians(degrees))))
        return np.mean(shared)

    config = TrackerConfig()
    assert overlap(config) > max(0.6, overlap(replace(config, rotation=False)) + 0.04)
