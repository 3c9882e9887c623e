# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Fitted constants of the confidence, in the order of ``Features`` and the bias last."""

CALIBRATION = (3.72, 0.61, 3.46, -3.06, -1.63, -2.67, -4.21)
CALIBRATION_WITH_NETWORK = (4.07, 0.7, 1.81, -0.09, 0.1, 0.66, 2.88, -3.21, -5.81)
