# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The constants that are fitted to data, as one value; ``fitted.py`` holds those in use."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Calibration:
    """Weights of two logistic regressions, without units.

    Attributes:
        without_network: of "the box is right" on the six ``confidence.Features``, then the bias.
        with_network: of the same on these and the three of ``fusion.Agreement``, then the bias.
    """

    without_network: tuple[float, ...]
    with_network: tuple[float, ...]
