# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The whole path with a network: ONNX files, cv2.dnn, proposal, fusion; on one thread and two."""

import copy
import pickle
import threading
from dataclasses import replace

import numpy as np
import pytest
from moving_target import FIRST_BOX, moving_target

from het_ros import Box, HierarchicalEnsembleTracker, State, TrackerConfig
from het_ros.tracking.bottom import second_thread
from het_ros.tracking.bottom.network import NetworkEnsemble
from het_ros.tracking.bottom.siamese import Siamese

DT = 1 / 30


@pytest.fixture(params=["made", "nanotrackv2", "nanotrackv3"])
def network(request):
    """The folder of a network: made for the tests, or real."""
    if request.param == "made":
        return str(request.getfixturevalue("made_network"))
    return str(request.getfixturevalue("models") / request.param)


@pytest.fixture
def two(monkeypatch):
    """Two processors, wherever this runs."""
    monkeypatch.setattr(second_thread, "processors", lambda: 2)


@pytest.fixture
def places(monkeypatch):
    """The threads in which networks were asked, by their identity."""
    found, look = [], Siamese.look

    def noted(self, *arguments):
        found.append(threading.get_ident())
        return look(self, *arguments)

    monkeypatch.setattr(Siamese, "look", noted)
    return found


def followed(config, images, box):
    tracker = HierarchicalEnsembleTracker(config)
    return [tracker.init(images[0], box), *(tracker.update(image, DT) for image in images[1:])]


def assert_same(one, other):
    for first, second in zip(one, other, strict=True):
        assert (first.box, first.velocity, first.score) == (
            second.box,
            second.velocity,
            second.score,
        )
        assert (first.state, first.patches) == (second.state, second.patches)
        np.testing.assert_array_equal(first.covariance, second.covariance)


def test_a_made_network_takes_part(made_network):
    images, box = moving_target(20), Box(*FIRST_BOX)
    config = TrackerConfig(network=str(made_network))
    found = followed(config, images, box)
    without = followed(replace(config, network=""), images, box)
    assert found[-1].state is State.TRACKING
    assert found[-1].box.iou(without[-1].box) > 0.3
    aspect = [estimate.box.w / estimate.box.h for estimate in (found[-1], without[-1])]
    assert abs(aspect[0] - aspect[1]) > 1e-6, "the network's boxes have a shape of their own"


@pytest.mark.parametrize("name", ["Crossing", "David"])
def test_one_thread_and_two_are_the_same_to_the_bit(network, sequence, name, two, places):
    real = sequence(name)
    images = [real.image(index) for index in range(12)]
    config = TrackerConfig(network=network)
    beside = followed(config, images, real.boxes[0])
    assert len(set(places[1:])) == 1, "one thread does all looks"
    assert threading.get_ident() not in places[1:]
    places.clear()
    alone = followed(replace(config, network_thread=False), images, real.boxes[0])
    assert set(places) == {threading.get_ident()}
    assert_same(beside, alone)


def test_a_target_that_jumps_is_looked_for_again_with_the_same_result(made_network, two):
    """The made network sees farther than the ensembles' window."""
    images = moving_target(12)
    images[8:] = [np.roll(image, 30, axis=1) for image in images[8:]]
    config = TrackerConfig(network=str(made_network))
    beside = followed(config, images, Box(*FIRST_BOX))
    assert_same(beside, followed(replace(config, network_thread=False), images, Box(*FIRST_BOX)))


def test_one_processor_is_one_thread(made_network, monkeypatch, places):
    monkeypatch.setattr(second_thread, "processors", lambda: 1)
    followed(TrackerConfig(network=str(made_network)), moving_target(3), Box(*FIRST_BOX))
    assert set(places) == {threading.get_ident()}


@pytest.mark.parametrize("thread", [True, False])
def test_what_the_network_raises_reaches_the_caller(made_network, two, monkeypatch, thread):
    images, box = moving_target(4), Box(*FIRST_BOX)
    tracker = HierarchicalEnsembleTracker(
        TrackerConfig(network=str(made_network), network_thread=thread)
    )
    tracker.init(images[0], box)
    with monkeypatch.context() as broken:
        broken.setattr(Siamese, "_maps", lambda *_: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            tracker.update(images[1], DT)
    assert tracker.update(images[2], DT).state is State.TRACKING


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_copy_has_the_same_network_and_its_own_thread(made_network, two, places, copied):
    (image, after), box = moving_target(2), Box(*FIRST_BOX)
    network = NetworkEnsemble(made_network, beside=True)
    network.start(image, box)
    where = np.array(box.centre), np.array([box.w, box.h])
    mine, its = (one.begin(after, *where)() for one in (network, copied(network)))
    assert mine.box == its.box
    np.testing.assert_array_equal(mine.resemblance.search, its.resemblance.search)
    np.testing.assert_array_equal(mine.resemblance.target, its.resemblance.target)
    assert len({*places, threading.get_ident()}) == 3
