# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The clock of the bench's camera, on a clock of the test's own."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from het_ros.bench import camera as module
from het_ros.bench.camera import LAG, WARM_UP, Camera, spun
from het_ros.bench.footage import Footage, middle

RATE = 10.0
IMAGES = 20  # that are counted


@pytest.fixture
def periods(own_environment, monkeypatch):
    """``periods({image: hold_up})``: when each image went, in periods from the first counted."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    now = [100.0]
    monkeypatch.setattr(module, "time", SimpleNamespace(perf_counter=lambda: now[0]))
    footage = Footage(32, 24, 2)

    def run(hold_ups: dict[int, float]) -> np.ndarray:
        with spun(lambda: Camera(footage, RATE)) as (camera, _):

            def spin(seconds: float) -> None:
                late = hold_ups.pop(len(camera.sent) - 1, 0.0) / RATE
                now[0] += max(seconds, 0.0) + late

            camera.run(IMAGES / RATE, middle(footage, (8, 8)), spin, lambda: None)
            camera.finish(spin)
            camera._publish(round(WARM_UP * RATE + IMAGES))  # does not count
            times = np.array(list(camera.sent.values()))
        return (times - times[0]) * RATE

    return run


def test_images_keep_to_a_schedule(periods):
    np.testing.assert_allclose(periods({}), np.arange(IMAGES), atol=1e-6)


def test_a_late_image_goes_at_once_and_the_schedule_stays(periods):
    """Image 5 is held up until 2.5 periods after it; 6 and 7 go at once, 8 when it is due."""
    expected = np.arange(IMAGES, dtype=float)
    expected[6:8] = 5 + 2.5
    np.testing.assert_allclose(periods({5: 2.5}), expected, atol=1e-6)


def test_a_long_hold_up_puts_the_schedule_off(periods):
    """With the late image go those of LAG periods at once, and not those of all 15."""
    went = periods({5: 15.0})
    assert np.count_nonzero(np.isclose(went, 20.0, atol=1e-6)) == LAG + 1
    np.testing.assert_allclose(np.diff(went[6 + LAG :]), 1.0, atol=1e-6)
