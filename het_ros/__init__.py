# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""het_ros: follow one target on a camera stream, and say so when it is lost."""

from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

__all__ = ["Box", "Estimate", "HierarchicalEnsembleTracker", "State", "TrackerConfig"]
