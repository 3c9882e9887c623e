# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from het_ros.tracking.estimate import lasting_deviation


def test_less_sure_is_less_exact():
    deviations = [lasting_deviation(score) for score in (1.0, 0.8, 0.5, 0.0)]
    assert deviations == sorted(set(deviations))
    assert deviations[0] > 0
