# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Constants that ``make fit`` writes; not to be edited by hand."""

from het_ros.tracking.calibration import Calibration

FITTED = Calibration(
    without_network=(3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21),
    with_network=(4.07, 0.7, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, -5.81),
    network_is_right=(4.28, 2.07, -0.9, 1.03),
)

# What the tracker ran with while it was recorded.
RECORDED_WITH = Calibration(
    without_network=(3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21),
    with_network=(4.07, 0.7, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, -5.81),
    network_is_right=(4.28, 2.07, -0.9, 1.03),
)
