# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from het_ros.bench.node import run_case
from het_ros.tools.tracker_process import TrackerProcessError, find_tracker


@pytest.mark.parametrize("how", ["one", "two"])
def test_boxes_come_back_and_the_process_is_weighed(how):
    if how == "two":
        try:
            find_tracker()
        except TrackerProcessError as error:
            pytest.skip(str(error))
    case = run_case("--size=320x240", "--rate=10", "--seconds=2", f"--how={how}")
    assert case["sent"] == 20
    assert case["dropped"] < case["sent"]
    assert case["latency"]["p50_ms"] >= case["own"]["p50_ms"] > 0
    assert case["rss_mb"] > 10
    assert case["cpu_share"] > 0


def test_the_core_alone_is_timed_on_every_frame():
    case = run_case("--size=320x240", "--rate=100", "--seconds=0.1", "--how=core")
    assert len(case["times"]) == 10
    assert min(case["times"]) > 0
