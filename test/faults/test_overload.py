# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Three times as many frames as the installed tracker can process."""

from het_ros.faults.overload import overload


def test_newest_wins_and_every_other_frame_is_counted(installed, own_environment):
    # With many features it is slow enough for any camera on the same machine.
    measured = overload((320, 240), 3.0, ("features:=300",))
    assert 1.5 < measured["times"] < 3.1  # of what it can process; 3 where the camera gets there
    assert measured["answered"] < measured["sent"]
    # Every frame from the first on was processed or counted as dropped.
    assert measured["all_counted"] and measured["counts"]["dropped"] > 0
    # In frame times of processing, so that it does not depend on how fast the machine is.
    assert measured["latency_frames"]["p50"] < 2
    assert measured["memory_growth"] < 0.1
