# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import os
from itertools import islice

import numpy as np
import pytest
import rclpy
from rclpy.context import Context

from het_ros import State
from het_ros.scene import Scene, SceneConfig
from het_ros.tools.closed_loop import Loop
from het_ros.tracking.bottom.network import NetworkEnsemble


@pytest.fixture
def loops(monkeypatch):
    """Makes loops: a robot four metres from a figure that walks up and down behind a column."""
    monkeypatch.setitem(os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    context = Context()
    rclpy.init(context=context)
    made = []

    def make(seed: int = 0, **more) -> Loop:
        scene = Scene(SceneConfig(story="patrol", seed=seed, width=320, height=240, rate=15.0))
        made.append(Loop(scene, 4.0, context, **more))
        return made[-1]

    yield make
    for loop in made:
        loop.close()
    rclpy.try_shutdown(context=context)


@pytest.fixture
def loop(loops):
    return loops()


def test_the_robot_keeps_the_figure_in_view_for_a_minute_and_through_occlusions(loop):
    moments = list(loop.run())
    assert len(moments) == 60 * 15
    assert all(moment.in_view for moment in moments)
    hidden = [moment for moment in moments if moment.frame.visible < 0.02]
    assert len(hidden) > 2 * 15  # s: several passes behind the column
    assert not any(moment.row.state is State.TRACKING for moment in hidden)
    seen = [moment for moment in moments if moment.frame.visible > 0.5]
    tracked = [m.row.state is State.TRACKING and m.row.box.iou(m.frame.box) > 0.3 for m in seen]
    assert np.mean(tracked) > 0.85
    assert all(2.0 < moment.away < 8.0 for moment in moments)
    assert min(moment.clearance for moment in moments) > 0.3


def test_the_same_seed_is_the_same_loop(loops):
    first, second = (list(islice(loops(seed=1).run(), 40)) for _ in range(2))
    assert [(m.row, m.command, m.away) for m in first] == [
        (m.row, m.command, m.away) for m in second
    ]


@pytest.mark.parametrize("depth", [True, False])
def test_depth_is_given_or_not(loops, depth):
    loop = loops(depth=depth)
    list(islice(loop.run(), 2))
    assert ("depth" in loop.tracker.space.came) is depth


def test_the_tracker_gets_the_network(loops, made_network, monkeypatch):
    given = []
    monkeypatch.setattr(NetworkEnsemble, "start", lambda self, image, box: given.append(image))
    next(loops(network=str(made_network)).run())
    assert len(given) == 1


def test_the_robot_stands_still_within_half_a_second_of_a_loss(loop):
    moments = loop.run()
    for moment in moments:
        if moment.frame.stamp > 1.5:
            break
    assert moment.command != (0, 0)
    loop.tracker.on_image = lambda message: None  # the camera's images do not come any more
    stamp = moment.frame.stamp
    for moment in moments:
        if moment.frame.stamp > stamp + 0.5:
            break
    assert moment.command == (0, 0)
