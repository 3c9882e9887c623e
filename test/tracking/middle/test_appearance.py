# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The base ensembles' place and that of a network which is made, in a target."""

import math

import numpy as np
import pytest

from het_ros import Box, TrackerConfig
from het_ros.tracking import target

from .proposals import SIZE, proposal


class MadeNetwork:
    """Proposes what it was told."""

    said = proposal(SIZE)

    def __init__(self, folder, beside):
        pass

    def start(self, image, box):
        pass

    def begin(self, image, at, size):
        return lambda: self.said


@pytest.fixture
def started(noise, monkeypatch):
    """A target that stands still at (70, 55), with a made network."""
    monkeypatch.setattr(target, "NetworkEnsemble", MadeNetwork)
    box = Box.from_centre(70, 55, *SIZE)
    return target.Target(TrackerConfig(network="made"), noise, box)


@pytest.mark.parametrize(
    ("centre", "score", "goes"),
    [
        ((74.0, 55.0), 0.9, (72.4, 55.0)),  # they agree: 0.6 of the way
        ((74.0, 55.0), 0.1, (72.4, 55.0)),
        ((40.0, 85.0), 0.4, (70.0, 55.0)),  # it is unsure
        ((90.0, 55.0), 0.6, (90.0, 55.0)),  # it is sure
    ],
)
def test_the_tracker_goes_where_both_say_or_the_network_if_it_is_sure(
    started, noise, monkeypatch, centre, score, goes
):
    monkeypatch.setattr(MadeNetwork, "said", proposal(SIZE, score, centre=centre))
    started.follow(noise, 1 / 30)
    np.testing.assert_allclose(started.judged.centre, goes, atol=0.6)
    agreement = started.confidence.agreement
    assert agreement.network_score == score
    assert agreement.resemblance == pytest.approx(0.8)
    assert 0 <= agreement.apart <= 1


class Counting:
    """A base ensemble of somebody else: notes what it is asked, and says nothing."""

    def __init__(self):
        self.looks = []

    def vote(self, look):
        self.looks.append(look)

    def learn(self, look, box, weight):
        pass

    def forget(self):
        pass


@pytest.mark.parametrize(
    ("centre", "score", "again"),
    [((75.0, 55.0), 0.9, False), ((120.0, 90.0), 0.9, True), ((120.0, 90.0), 0.4, False)],
)
def test_a_sure_place_beyond_the_window_is_looked_at_instead(
    noise, monkeypatch, centre, score, again
):
    monkeypatch.setattr(target, "NetworkEnsemble", MadeNetwork)
    monkeypatch.setattr(MadeNetwork, "said", proposal(SIZE, score, centre=centre))
    ensemble = Counting()
    config, box = TrackerConfig(network="made"), Box.from_centre(70, 55, *SIZE)
    looking = target.Target(config, noise, box, further=[lambda image, box: ensemble])
    looking.follow(noise, 1 / 30)
    (look,) = ensemble.looks  # it is asked once a frame
    rows, columns = look.places
    middle = look.centre_of(np.array([columns - 1, rows - 1]) / 2)
    np.testing.assert_allclose(middle, centre if again else (70, 55), atol=1.0)


def test_the_trackers_size_follows_the_networks(started, noise, monkeypatch):
    monkeypatch.setattr(MadeNetwork, "said", proposal(1.1 * SIZE, centre=(70.0, 55.0)))
    box = started.follow(noise, 1 / 30).box
    assert 1.02 < math.sqrt(box.area / SIZE.prod()) < 1.06
