# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which outputs are recorded of which bag."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from het_ros.tools.bag_messages import CAMERA_INFO, COMPRESSED_IMAGE, IMAGE
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.outputs import OUTPUT_TYPES
from het_ros.tools.recorder import outputs_from

WITH_DEPTH = {"target_pose", "target_pose_cov", "target_velocity"}
WITH_CAMERA_INFO = WITH_DEPTH | {"bearing"}
SHIPPED = Path(__file__).resolve().parents[2] / "bags" / "follow_walk"


@pytest.mark.parametrize(
    ("kinds", "without"),
    [
        ([IMAGE], WITH_CAMERA_INFO),
        ([IMAGE, IMAGE], WITH_CAMERA_INFO),  # no ray without the camera's matrix
        ([COMPRESSED_IMAGE, CAMERA_INFO], WITH_DEPTH),
        ([COMPRESSED_IMAGE, CAMERA_INFO, IMAGE], set()),
    ],
)
def test_what_lacks_its_input_is_left_out(kinds, without):
    topics = {f"/topic_{k}": kind for k, kind in enumerate(kinds)}
    names = outputs_from(SimpleNamespace(topics=topics))
    assert set(OUTPUT_TYPES) - set(names) == without


def test_the_shipped_bag_has_no_depth():
    with BagReader(SHIPPED) as bag:
        assert set(OUTPUT_TYPES) - set(outputs_from(bag)) == WITH_DEPTH
