# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Three times as many frames as the installed tracker can process."""

from het_ros.faults.overload import overload


def test_newest_wins_and_every_other_frame_is_counted(installed, own_environment):
    # With many features it is slow enough for any camera on the same machine.
    measured = overload((320, 240), 3.0, ("features:=300",))
    assert 0 < measured["answered"] < measured["sent"]
    # Every frame from the first on was processed or counted as dropped.
    assert measured["all_counted"] and measured["counts"]["dropped"] > 0
    # How late it was depends on what else runs here: it is measured, and judged by who reads it.
    assert 0 < measured["latency_frames"]["p50"] <= measured["latency_frames"]["p99"]
    assert measured["times"] > 0 < measured["capacity"]
    assert measured["memory_growth"] < 0.1
