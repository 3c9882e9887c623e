# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Crop, forward pass and decoding; the networks themselves where they are."""

import cv2
import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.bottom import siamese
from het_ros.tracking.bottom.siamese import STRIDE, Siamese


@pytest.fixture(scope="module", params=[("nanotrackv2", 16), ("nanotrackv3", 15)])
def network(models, request):
    folder, places = request.param
    return Siamese.read(models / folder), places


def test_a_crop_of_its_own_size_is_the_image():
    image = np.random.default_rng(0).integers(0, 255, (60, 80, 3), dtype=np.uint8)
    np.testing.assert_array_equal(siamese.crop(image, (30, 25), 20, 20), image[15:35, 20:40])


def test_a_crop_is_scaled_about_its_middle():
    image = np.zeros((100, 100, 3), np.uint8)
    image[48:52, 58:62] = 255
    small = siamese.crop(image, (60, 50), 40, 20)
    assert (np.argwhere(small[..., 0] > 200) == [[9, 9], [9, 10], [10, 9], [10, 10]]).all()


def test_beyond_the_image_is_its_mean_colour():
    image = np.full((40, 40, 3), (10, 20, 30), np.uint8)
    image[:, 20:] = (50, 60, 70)
    outside = siamese.crop(image, (0, 20), 40, 40)
    np.testing.assert_array_equal(outside[5:35, :15], np.full((30, 15, 3), (30, 40, 50)))


def test_the_crop_holds_the_box_and_its_context():
    """127 px of template for twice the side of a square box."""
    assert siamese.crop_side(10, 10) == pytest.approx(20)
    assert siamese.crop_side(40, 10) == pytest.approx(np.sqrt(65 * 35))


@pytest.mark.parametrize("n", [15, 16])
def test_boxes_are_placed_as_in_a_slow_loop(n):
    sides = np.random.default_rng(n).uniform(1, 60, (4, n, n)).astype(np.float32)
    found = siamese.placed(sides, (200, 120), 0.5)
    for row in range(n):
        for column in range(n):
            left, top, right, bottom = sides[:, row, column]
            x, y = (column - n // 2) * STRIDE, (row - n // 2) * STRIDE
            box = 200 + 0.5 * (x - left), 120 + 0.5 * (y - top)
            size = 0.5 * (left + right), 0.5 * (top + bottom)
            np.testing.assert_allclose(found[:, row, column], (*box, *size), rtol=1e-5)


def test_probabilities_are_a_softmax_and_never_overflow():
    classes = np.array([[[0, 500, -500]], [[1, -500, 500]]], np.float32)
    with np.errstate(over="raise"):
        found = siamese.probability(classes)[0]
    np.testing.assert_allclose(found, [1 / (1 + np.exp(-1)), 0, 1], atol=1e-6)


def test_versions_are_told_by_their_places(network):
    read, places = network
    assert (read.places, read.version) == (places, {16: "v2", 15: "v3"}[places])


def test_it_finds_the_target_that_moved(network, sequences):
    """In the third frame of Crossing, from the box of the first."""
    read, n = network
    files = sorted((sequences / "Crossing" / "img").iterdir())
    box = Box(204, 150, 17, 50)
    read.template(cv2.imread(str(files[0])), box)
    score, boxes = read.look(cv2.imread(str(files[2])), (212, 175), (17, 50))
    assert (score.shape, score.dtype) == ((n, n), np.float32)
    assert (boxes.shape, boxes.dtype) == ((4, n, n), np.float32)
    best = np.unravel_index(score.argmax(), score.shape)
    assert score[best] > 0.8
    assert box.iou(Box(*(float(v) for v in boxes[:, best[0], best[1]]))) > 0.5
    alike = read.resemblance()
    assert alike.at(box.centre) > 0.7
    assert all(alike.at(place) < 0.6 for place in ((205, 225), (240, 175), (180, 175)))


def test_a_look_does_not_change_what_another_made(network, sequences):
    read, _ = network
    image = cv2.imread(str(sequences / "Crossing" / "img" / "0001.jpg"))
    read.template(image, Box(204, 150, 17, 50))
    first = read.look(image, (212, 175), (17, 50))
    kept = [values.copy() for values in first]
    read.look(image, (100, 100), (30, 30))
    for before, now in zip(kept, first, strict=True):
        np.testing.assert_array_equal(before, now)


@pytest.mark.parametrize("names", [[], ["a_backbone.onnx"], ["backbone.onnx", "head.onnx"]])
def test_a_folder_that_is_no_network_is_one_line(tmp_path, names):
    for name in names:
        (tmp_path / name).write_bytes(b"nothing")
    with pytest.raises(ValueError, match=r"one NanoTrack network|cannot be read as an ONNX"):
        Siamese.read(tmp_path)
