# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import tracemalloc

import pytest

from het_ros import Box, HierarchicalEnsembleTracker, TrackerConfig
from het_ros.tracking.cost import megabytes


@pytest.mark.parametrize(
    "config, box",
    [
        (TrackerConfig(), Box(40, 40, 1e6, 1e-5)),  # as narrow as that, it took all memory
        (TrackerConfig(), Box(-1e6, 40, 2e6, 2)),
        (TrackerConfig(working_side=1000.0, search_radius=200.0), Box(40, 40, 20, 30)),
        (TrackerConfig(features=2000, most_memory=50.0), Box(40, 40, 20, 30)),
    ],
)
def test_what_would_take_too_much_memory_is_refused(config, box, noise):
    tracker = HierarchicalEnsembleTracker(config)
    with pytest.raises(ValueError, match="most_memory"):
        tracker.init(noise, box)


@pytest.mark.parametrize(
    "config, box, cells",
    [
        (TrackerConfig(), Box(40, 40, 20, 20), (24, 24)),
        (TrackerConfig(features=1000), Box(40, 40, 20, 20), (24, 24)),
        (TrackerConfig(working_side=200.0), Box(40, 40, 20, 20), (100, 100)),
        (TrackerConfig(search_radius=200.0), Box(40, 40, 20, 20), (24, 24)),
    ],
)
def test_the_estimate_is_right_to_a_factor(config, box, cells, noise):
    tracemalloc.start()
    try:
        tracker = HierarchicalEnsembleTracker(config)
        tracker.init(noise, box)
        tracker.update(noise, 1 / 30)
        peak = tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()
    assert peak / 2 < megabytes(config, cells) < 5 * peak


def test_a_box_that_is_refused_leaves_the_track_as_it_was(noise):
    tracker = HierarchicalEnsembleTracker()
    tracker.init(noise, Box(60, 40, 20, 30))
    with pytest.raises(ValueError, match="smaller or less narrow box"):
        tracker.init(noise, Box(-1e6, 40, 2e6, 2))
    estimate = tracker.update(noise, 1 / 30)
    assert estimate.box.iou(Box(60, 40, 20, 30)) > 0.9
