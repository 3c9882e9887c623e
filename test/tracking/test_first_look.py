# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from sight import seen

from het_ros.tracking.first_look import FirstLook

NAMES = ["David", "Crossing", "Couple", "Car1", "FaceOcc1"]


def settled(look, frames, zoom=1.0, beside=(0.0, 0.0), times=40, **sight):
    """(off (2,), growth, likeness): where the corrections of one picture lead to."""
    off, growth = np.array(beside), 1.0
    for _ in range(times):
        planes, centre, size = seen(frames, zoom / growth, beside=off, **sight)
        correction = look.correction(planes, centre)
        off = off + correction.shift / size
        growth *= correction.ratio
    return off, growth, correction.likeness


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    ("zoom", "beside"),
    [
        (1.0, (0.0, 0.0)),
        (1.0, (0.1, 0.0)),
        (1.0, (-0.05, 0.12)),
        (1.08, (0.0, 0.0)),
        (0.95, (0.03, -0.03)),
    ],
)
def test_a_known_change_of_a_real_frame_is_taken_back(sequence, name, zoom, beside):
    frames = sequence(name)
    look = FirstLook(*seen(frames))
    off, growth, likeness = settled(look, frames, zoom, beside)
    np.testing.assert_allclose(off, 0.0, atol=0.015)
    assert growth == pytest.approx(zoom, abs=0.02)
    assert likeness > 0.95


@pytest.mark.parametrize("name", ["David", "Car1", "FaceOcc1"])
def test_it_leads_to_where_a_search_finds_the_first_frame_again(sequence, name):
    """Later frames: the slow way tries places and sizes all around, without a step."""
    frames = sequence(name)
    look = FirstLook(*seen(frames))
    for index in (4, 8, 12):
        off, growth, likeness = settled(look, frames, beside=(0.06, -0.06), index=index)
        best = -1.0
        for x in np.arange(-0.12, 0.13, 0.03):
            for y in np.arange(-0.12, 0.13, 0.03):
                for zoom in (0.94, 1.0, 1.06):
                    planes, centre, size = seen(frames, zoom, index=index)
                    one = (centre + np.array([x, y]) * size)[None]
                    found = look._features(planes, one[0], np.zeros((1, 3)))[0]
                    best = max(best, look._likeness(found))
        assert likeness > best - 0.02
        assert np.abs(off).max() < 0.2
        assert 0.8 < growth < 1.25


@pytest.mark.parametrize("name", NAMES)
def test_brightness_and_contrast_change_nothing(sequence, name):
    frames = sequence(name)
    planes, centre, size = seen(frames)
    darker = tuple((0.5 * plane + 30).astype(np.uint8) for plane in planes)
    correction = FirstLook(planes, centre, size).correction(darker, centre)
    np.testing.assert_allclose(correction.shift / size, 0.0, atol=0.01)
    assert correction.ratio == pytest.approx(1.0, abs=0.002)
    assert correction.likeness > 0.95


@pytest.mark.parametrize("name", ["Crossing", "Couple", "Car1"])
@pytest.mark.parametrize("other", ["David", "FaceOcc1"])
def test_something_else_is_not_like_it_and_moves_nothing_far(sequence, name, other):
    look = FirstLook(*seen(sequence(name)))
    planes, centre, size = seen(sequence(other))
    correction = look.correction(planes, centre)
    assert correction.likeness < 0.35
    assert np.abs(correction.shift / size).max() < 0.05


def test_half_of_it_is_like_it_in_part(sequence):
    planes, centre, size = seen(sequence("David"))
    look = FirstLook(planes, centre, size)
    rng = np.random.default_rng(0)
    hidden = []
    for plane in planes:
        covered = plane.copy()
        x = int(centre[0])
        covered[:, x:] = rng.integers(0, 256, covered[:, x:].shape)
        hidden.append(covered)
    assert 0.2 < look.correction(hidden, centre).likeness < 0.9


@pytest.mark.parametrize("level", [0, 77, 255])
def test_without_contrast_nothing_is_known(level):
    flat = (np.full((40, 50), level, np.uint8),) * 3
    centre = np.array([25.0, 20.0])
    correction = FirstLook(flat, centre, (12, 16)).correction(flat, centre)
    np.testing.assert_array_equal(correction.shift, 0.0)
    assert correction.ratio == 1.0
    assert correction.likeness == pytest.approx(0.0, abs=1e-6)
