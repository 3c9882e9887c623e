# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Constants that ``make fit`` writes; not to be edited by hand."""

from het_ros.tracking.calibration import Calibration

FITTED = Calibration(
    without_network=(0.81, 2.25, -0.69, 3.74, -3.29, -2.46, -2.4, -2.49),
    with_network=(0.93, 3.14, 0.34, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, -5.81),
    network_is_right=(4.28, 2.07, -0.9, 1.03),
)

# What the tracker ran with while it was recorded.
RECORDED_WITH = Calibration(
    without_network=(0.81, 2.25, -0.69, 3.74, -3.29, -2.46, -2.4, -2.49),
    with_network=(0.93, 3.14, 0.34, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, -5.81),
    network_is_right=(4.28, 2.07, -0.9, 1.03),
)
