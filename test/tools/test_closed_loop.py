import os

import pytest
import rclpy
from rclpy.context import Context

from het_ros import State
from het_ros.scene import Scene, SceneConfig
from het_ros.tools.closed_loop import Loop


@pytest.fixture
def loop(monkeypatch):
    """The robot four metres from a figure that walks up and down."""
    monkeypatch.setitem(os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    context = Context()
    rclpy.init(context=context)
    scene = Scene(SceneConfig(story="patrol", seed=0, width=320, height=240, rate=15.0))
    made = Loop(scene, 4.0, context)
    yield made
    made.close()
    rclpy.try_shutdown(context=context)


def test_the_robot_follows_until_the_figure_goes_behind_the_column(loop):
    for moment in loop.run():
        if moment.frame.stamp > 3.0:
            break
        assert moment.in_view
        assert 2.5 < moment.away < 6.0
        assert moment.row.state is State.TRACKING
    assert abs(moment.frame.box.centre[0] - 160) < 80  # it turned with the figure


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
