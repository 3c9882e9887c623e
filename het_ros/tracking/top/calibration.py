# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Fitted constants of the confidence, in the order of ``Features`` and the bias last."""

CALIBRATION = (0.81, 2.25, -0.69, 3.74, -3.29, -2.46, -2.4, -2.49)
CALIBRATION_WITH_NETWORK = (0.93, 3.14, 0.34, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, -5.81)
