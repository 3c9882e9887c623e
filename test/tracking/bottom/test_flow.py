# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Flow of made motions: where the target's pixels went, and how much they spread."""

import math

import cv2
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.bottom.flow import FlowEnsemble

from .looks import look_at

SHAPE = (120, 140)  # (w, h) of the windows, px
BOX = Box(140.0, 110.0, 40.0, 60.0)
CORNER = (100.0, 70.0)


def picture(seed=0):
    noise = np.random.default_rng(seed).integers(0, 256, (300, 360, 3), dtype=np.uint8)
    return cv2.GaussianBlur(noise, (0, 0), 2)


def shifted(image, dx, dy):
    matrix = np.array([[1, 0, dx], [0, 1, dy]], np.float32)
    return cv2.warpAffine(image, matrix, image.shape[1::-1], borderMode=cv2.BORDER_REFLECT)


def zoomed(image, zoom, centre=BOX.centre):
    """The image ``zoom`` times as large around a place."""
    x, y = centre
    matrix = np.array(
        [[zoom, 0, x - 0.5 - zoom * (x - 0.5)], [0, zoom, y - 0.5 - zoom * (y - 0.5)]]
    )
    return cv2.warpAffine(image, matrix, image.shape[1::-1], borderMode=cv2.BORDER_REFLECT)


def look(image, corner=CORNER, scale=1.0, expected=BOX.centre, confidence=1.0, shape=SHAPE):
    return look_at(
        image,
        corner,
        shape,
        scale,
        expected=expected,
        cells=(40, 60),
        places=(shape[1] - 59, shape[0] - 39),
        confidence=confidence,
    )


def started(image, **options):
    flow = FlowEnsemble(1)
    flow.learn(look(image, **options), BOX, 1.0)
    return flow


@pytest.mark.parametrize(
    ("shift", "guess", "corner", "scale"),
    [
        ((0.0, 0.0), (0.0, 0.0), (100.0, 70.0), 1.0),
        ((3.4, -2.2), (0.0, 0.0), (100.0, 70.0), 1.0),
        ((3.0, 2.0), (3.0, 2.0), (103.0, 72.0), 1.0),
        ((12.0, -9.0), (10.0, -10.0), (112.5, 60.0), 1.0),  # another window, a near guess
        ((4.0, 3.0), (0.0, 0.0), (95.0, 65.0), 0.9),  # and another scale
    ],
)
def test_the_target_goes_where_its_pixels_go(shift, guess, corner, scale):
    flow = started(picture())
    expected = np.add(BOX.centre, guess)
    after = look(shifted(picture(), *shift), corner, scale, expected)
    votes = flow.vote(after)
    np.testing.assert_allclose(flow.flow.centre, np.add(BOX.centre, shift), atol=0.3)
    np.testing.assert_allclose(flow.flow.shift, shift, atol=0.3)
    assert flow.flow.share > 0.9
    assert votes.shape == after.places
    row, column = divmod(int(votes.argmax()), votes.shape[1])
    place = after.corner_of(flow.flow.centre)
    inside = np.clip(place, 0, np.array(after.places[::-1]) - 1)
    np.testing.assert_allclose((column, row), inside, atol=0.51)


@pytest.mark.parametrize("zoom", [0.92, 0.96, 0.98, 1.0, 1.02, 1.04, 1.08])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_known_zoom_is_measured(zoom, seed):
    flow = started(picture(seed))
    flow.vote(look(zoomed(picture(seed), zoom)))
    assert flow.flow.growth == pytest.approx(math.log(zoom), abs=0.003)
    assert flow.flow.deviation < 0.03


@pytest.mark.parametrize("zoom", [0.96, 1.0, 1.04])
@pytest.mark.parametrize("name", ["David", "Crossing", "Couple"])
def test_a_known_zoom_of_a_real_frame_is_measured(sequence, name, zoom):
    frames = sequence(name)
    image, box = frames.image(0), frames.boxes[0]
    flow, scale = FlowEnsemble(1), 48 / math.sqrt(box.area)
    corner = np.array(box.centre) - 60 / scale

    def seen(picture):
        return look_at(
            picture, corner, (120, 120), scale, expected=box.centre, cells=(48, 48), places=(9, 9)
        )

    flow.learn(seen(image), box, 1.0)
    flow.vote(seen(zoomed(image, zoom, box.centre)))
    assert flow.flow.growth == pytest.approx(math.log(zoom), abs=0.01)
    np.testing.assert_allclose(flow.flow.shift, 0, atol=0.6)


@pytest.mark.parametrize("zoom", [0.95, 1.05])
def test_points_that_go_elsewhere_do_not_measure_the_growth(zoom):
    """A fifth of the target is covered by something that moves its own way."""
    flow, after = started(picture()), zoomed(picture(), zoom)
    after[:, 140:149] = shifted(picture(), 3.0, 1.0)[:, 140:149]
    flow.vote(look(after))
    assert flow.flow.growth == pytest.approx(math.log(zoom), abs=0.015)


def test_nothing_agrees_between_two_pictures():
    flow = started(picture())
    votes = flow.vote(look(picture(1)))
    assert votes is None or votes.max() < 0.3
    assert flow.flow is None or flow.flow.share < 0.3


def test_half_of_the_target_covered():
    """The points that still see the target say where it is, and fewer agree."""
    after = shifted(picture(), 2.0, 1.0)
    after[:, 162:] = picture(2)[:, 162:]
    flow = started(picture())
    votes = flow.vote(look(after))
    np.testing.assert_allclose(flow.flow.centre, np.add(BOX.centre, (2.0, 1.0)), atol=0.5)
    assert 0.2 < flow.flow.share < 0.8
    assert votes.max() == pytest.approx(flow.flow.share, abs=0.02)


@pytest.mark.parametrize(("confidence", "share"), [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (1, 1)])
def test_flow_counts_less_after_a_frame_of_doubt(confidence, share):
    votes = started(picture()).vote(look(picture(), confidence=confidence))
    assert votes.max() == pytest.approx(share, abs=0.03)


def test_a_flat_picture_has_no_flow():
    flat = np.full((300, 360), 90, np.uint8)
    flow = started(flat)
    assert flow.vote(look(flat)) is None
    assert flow.flow is None


@pytest.mark.parametrize("shape", [(120, 141), (90, 140)])
def test_windows_of_another_size_are_not_compared(shape):
    flow = started(picture())
    assert flow.vote(look(picture(), shape=shape)) is None


def test_nothing_is_known_at_first_and_after_the_target_was_hidden():
    assert FlowEnsemble(1).vote(look(picture())) is None
    flow = started(picture())
    assert flow.vote(look(picture())) is not None
    flow.forget()
    assert flow.flow is None
    assert flow.vote(look(picture())) is None
