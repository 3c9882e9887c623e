# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is made of a network's maps: against slow loops, and with real files on real frames."""

import math
from pathlib import Path

import numpy as np
import pytest

from het_ros import Box
from het_ros.tracking.bottom import network
from het_ros.tracking.bottom.network import NetworkConfig, NetworkEnsemble
from het_ros.tracking.bottom.resemblance import Resemblance
from het_ros.tracking.bottom.siamese import placed

CONFIG = NetworkConfig()
IMAGE = np.zeros((120, 160, 3), np.uint8)
FIRST = Box(60, 40, 20, 30)
N = 5
STEP = 0.25  # px of the image in one of the network's crop


class MadeNetwork:
    """A network of 5 x 5 places, 4 px apart, whose maps are given."""

    places = N

    def __init__(self):
        self.scores = np.full((N, N), 0.5, np.float32)
        self.sides = np.zeros((4, N, N), np.float32)
        self.sides[0::2], self.sides[1::2] = 10 / STEP, 15 / STEP  # the first box's size
        self.templates = []

    def template(self, image, box):
        self.templates.append((image.shape, box))

    def look(self, image, centre, size):
        self.alike = Resemblance(self.scores[None, :1, :1], self.scores[None], centre, 16 * STEP)
        return self.scores, placed(self.sides, centre, STEP)

    def resemblance(self):
        return self.alike


@pytest.fixture
def made(monkeypatch):
    """A made network, and the ensemble over it."""
    given = MadeNetwork()
    monkeypatch.setattr(network.Siamese, "read", staticmethod(lambda folder: given))
    return given, NetworkEnsemble(Path("made"))


def propose(ensemble, at=FIRST.centre):
    return ensemble.propose(IMAGE, np.array(at), np.array([20.0, 30.0]))


@pytest.mark.parametrize("image", [IMAGE, IMAGE[..., 0]], ids=["colour", "gray"])
def test_it_takes_the_first_box_of_any_image_once(made, image):
    given, ensemble = made
    ensemble.start(image, FIRST)
    propose(ensemble)
    assert given.templates == [((120, 160, 3), FIRST)]


def slow_proposal(given, first, at, size):
    """Row, column, ranks and boxes of all places, one at a time."""
    _, best_boxes = given.first
    hann = np.hanning(N)

    def around(w, h):
        return math.sqrt((w + (w + h) / 2) * (h + (w + h) / 2))

    stretch, offset = [], []
    x, y, w, h = best_boxes
    for wanted, seen in ((first.w, w), (first.h, h)):
        change = min(max(math.log(wanted / seen), -CONFIG.most_bias), CONFIG.most_bias)
        stretch.append(math.exp(CONFIG.bias * change))
    for wanted, found, seen in ((first.centre[0], x + w / 2, w), (first.centre[1], y + h / 2, h)):
        away = min(max((wanted - found) / seen, -CONFIG.most_bias), CONFIG.most_bias)
        offset.append(CONFIG.bias * away)
    boxes = placed(given.sides, at, STEP)
    ranks, found = {}, {}
    for row in range(N):
        for column in range(N):
            x, y, w, h = (float(v) for v in boxes[:, row, column])
            centre = x + w / 2 + offset[0] * w, y + h / 2 + offset[1] * h
            w, h = stretch[0] * w, stretch[1] * h
            larger, wider = around(w, h) / around(*size), w / h / (size[0] / size[1])
            change = max(larger, 1 / larger) * max(wider, 1 / wider)
            steady = math.exp(-CONFIG.penalty * (change - 1))
            rank = steady * float(given.scores[row, column]) * (1 - CONFIG.window)
            ranks[row, column] = rank + CONFIG.window * hann[row] * hann[column]
            found[row, column] = (*centre, w, h, steady)
    return ranks, found


@pytest.mark.parametrize("seed", range(6))
def test_the_proposal_is_that_of_a_slow_loop(made, seed):
    given, ensemble = made
    rng = np.random.default_rng(seed)
    ensemble.start(IMAGE, FIRST)
    hann = np.outer(np.hanning(N), np.hanning(N))
    given.sides = rng.uniform(20, 90, (4, N, N)).astype(np.float32)
    given.scores = rng.uniform(0, 1, (N, N)).astype(np.float32)
    best = np.unravel_index((given.scores * hann).argmax(), (N, N))
    given.first = None, placed(given.sides, FIRST.centre, STEP)[:, best[0], best[1]].tolist()
    ensemble.start(IMAGE, FIRST)
    given.sides = rng.uniform(20, 90, (4, N, N)).astype(np.float32)
    given.scores = rng.uniform(0, 1, (N, N)).astype(np.float32)
    ranks, boxes = slow_proposal(given, FIRST, (75.0, 50.0), (20.0, 30.0))
    found = propose(ensemble, (75.0, 50.0))
    row, column = max(ranks, key=ranks.get)
    x, y, w, h, steady = boxes[row, column]
    np.testing.assert_allclose((*found.box.centre, found.box.w, found.box.h), (x, y, w, h), 1e-5)
    assert found.score == pytest.approx(given.scores[row, column])
    assert found.steady == pytest.approx(steady, rel=1e-5)
    assert found.resemblance is given.alike


@pytest.mark.parametrize(
    ("scores", "larger", "best"),
    [
        ({}, {}, (2, 2)),  # all alike: where it is expected
        ({(1, 2): 0.6, (3, 2): 0.5}, {}, (2, 2)),  # a little likelier beside is not enough
        ({(1, 2): 1.0, (2, 2): 0.1}, {}, (1, 2)),  # much likelier is
        ({(1, 2): 1.0, (2, 2): 0.1, (2, 1): 0.95}, {(1, 2): 3.0}, (2, 1)),  # of a steadier size
    ],
)
def test_places_are_ranked_by_score_steadiness_and_distance(made, scores, larger, best):
    given, ensemble = made
    ensemble.start(IMAGE, FIRST)
    for place, score in scores.items():
        given.scores[place] = score
    for (row, column), times in larger.items():
        given.sides[:, row, column] *= times
    found = propose(ensemble)
    away = np.subtract(found.box.centre, FIRST.centre)
    np.testing.assert_allclose(away, 4 * np.array([best[1] - 2, best[0] - 2]), atol=1e-4)


@pytest.mark.parametrize(
    ("seen", "kept"),
    [
        (1.0, 1.0),
        (0.8, math.sqrt(0.8)),  # half of the difference, in logarithms
        (1.2, math.sqrt(1.2)),
        (0.5, 0.5 * math.exp(0.2)),  # no more than half of 0.4
        (2.0, 2.0 * math.exp(-0.2)),
    ],
)
def test_half_of_what_the_first_box_is_other_is_kept(made, seen, kept):
    """The network's boxes are ``seen`` times as wide as the given one."""
    given, ensemble = made
    given.sides[0::2] *= seen
    ensemble.start(IMAGE, FIRST)
    found = propose(ensemble)
    assert found.box.w == pytest.approx(kept * FIRST.w, rel=1e-5)
    assert found.box.h == pytest.approx(FIRST.h, rel=1e-5)


def test_half_of_how_far_the_first_box_lies_beside_is_kept(made):
    """The network's boxes lie a tenth of their width too far left."""
    given, ensemble = made
    given.sides[0] += 2 / STEP
    given.sides[2] -= 2 / STEP
    ensemble.start(IMAGE, FIRST)
    centre = propose(ensemble).box.centre
    np.testing.assert_allclose(np.subtract(centre, FIRST.centre), (-1, 0), atol=1e-4)


def test_a_folder_without_a_network_is_refused(tmp_path):
    with pytest.raises(ValueError, match="one NanoTrack network"):
        NetworkEnsemble(tmp_path)


@pytest.fixture(scope="module")
def real(models):
    return NetworkEnsemble(models / "nanotrackv3")


@pytest.mark.parametrize("name", ["Crossing", "David", "Car1"])
def test_on_real_frames_the_proposal_is_the_target(real, sequence, name):
    """Looked for at the place of three frames ago; a place without it is less like it."""
    frames = sequence(name)
    real.start(frames.image(0), frames.boxes[0])
    for index in (3, 6):
        before, truth = frames.boxes[index - 3], frames.boxes[index]
        size = np.array([before.w, before.h])
        found = real.propose(frames.image(index), np.array(before.centre), size)
        assert found.box.iou(truth) > 0.5
        assert found.score > 0.5
        below = truth.centre[0], truth.centre[1] + 1.5 * math.sqrt(truth.area)
        assert found.resemblance.at(below) < found.resemblance.at(truth.centre)
