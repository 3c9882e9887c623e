# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""het_ros: follow one target on a camera stream, and say so when it is lost."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from het_ros.tracking.box import Box
    from het_ros.tracking.config import TrackerConfig
    from het_ros.tracking.estimate import Estimate, State
    from het_ros.tracking.tracker import HierarchicalEnsembleTracker

__all__ = ["Box", "Estimate", "HierarchicalEnsembleTracker", "State", "TrackerConfig"]

_HOMES = {
    "Box": "box",
    "Estimate": "estimate",
    "HierarchicalEnsembleTracker": "tracker",
    "State": "estimate",
    "TrackerConfig": "config",
}


def __getattr__(name: str) -> Any:
    """Import what is asked for: an executable sees to its signals before NumPy and OpenCV load."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"het_ros.tracking.{_HOMES[name]}"), name)
