# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from dataclasses import dataclass

import numpy as np
import pytest

from het_ros import Box, Estimate, State
from het_ros.scene.honesty import Moment
from het_ros.scene.motion import ImageMotion
from het_ros.tools.scene_velocity import table, velocity_of

RATE = 20.0


@dataclass(frozen=True)
class InScene(Estimate):
    """An estimate that tells the target's own motion."""

    velocity_in_scene: tuple[float, float] | None = None


def moments(published, own=(40.0, 0.0), camera=(-30.0, 0.0), in_scene=None, count=40):
    """A box of 10 x 40 px, exactly on a target that moves 10 px/s in the image."""
    made = []
    for i in range(count):
        box = Box(100 + 10 * i / RATE, 50, 10, 40)
        values = box, published, np.eye(4), 1.0, State.TRACKING
        estimate = InScene(*values, velocity_in_scene=in_scene)
        made.append(Moment(estimate, 1.0, 1.0, 0.0, box, ImageMotion(own, camera)))
    return made


def test_the_truth_is_the_whole_motion_and_its_parts_are_told():
    found = velocity_of(moments((10.0, 0.0)), RATE)
    assert found["published"] == pytest.approx(0)
    assert found["zero"] == pytest.approx(10 / 20), "in sides: sqrt(10 * 40) px"
    assert (found["own"], found["camera"]) == (pytest.approx(2.0), pytest.approx(1.5))
    assert found["in_scene"] is None
    assert found["frames"] == 39


def test_a_velocity_in_the_scene_is_judged_by_the_own_motion():
    found = velocity_of(moments((10.0, 0.0), in_scene=(36.0, 0.0)), RATE)
    assert found["in_scene"] == pytest.approx(4 / 20)


def test_moments_without_truth_do_not_count():
    made = moments((10.0, 0.0))
    gone = [Moment(m.estimate, 0.0, 0.0, 0.0) for m in made[:10]]
    assert velocity_of([*made[:15], *gone, *made[15:]], RATE)["frames"] == 39
    assert velocity_of([made[0], *gone], RATE) is None


def test_a_row_a_story_and_one_for_all():
    slow, fast = (velocity_of(moments((v, 0.0)), RATE) for v in (10.0, 30.0))
    lines = table([("walk", slow), ("walk", None), ("hide", fast)]).splitlines()
    assert lines[2].startswith("| walk | 1 | 0.50 | 2.00 | 1.50 |")
    assert lines[3].startswith("| hide | 1 | 0.50 | 2.00 | 1.50 |")
    assert " | 0.50 | - | - |" in lines[4], "the mean of both errors"
    assert lines[4].startswith("| all | 2 |")
