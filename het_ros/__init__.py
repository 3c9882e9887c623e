# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""het_ros: follow one target on a camera stream, and say so when it is lost."""

from __future__ import annotations

from importlib import import_module, metadata
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from het_ros.tracking.box import Box
    from het_ros.tracking.config import TrackerConfig
    from het_ros.tracking.estimate import Estimate, Patch, State
    from het_ros.tracking.tracker import HierarchicalEnsembleTracker, Witness

    __version__: str

__all__ = [
    "Box",
    "Estimate",
    "HierarchicalEnsembleTracker",
    "Patch",
    "State",
    "TrackerConfig",
    "Witness",
    "__version__",
]

_HOMES = {
    "Box": "box",
    "Estimate": "estimate",
    "HierarchicalEnsembleTracker": "tracker",
    "Patch": "estimate",
    "State": "estimate",
    "TrackerConfig": "config",
    "Witness": "tracker",
}


def __getattr__(name: str) -> Any:
    """Import what is asked for: an executable sees to its signals before NumPy and OpenCV load."""
    if name == "__version__":
        return metadata.version(__name__)
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        return getattr(import_module(f"het_ros.tracking.{_HOMES[name]}"), name)
    except ModuleNotFoundError as error:
        if error.name != "cv2":
            raise
        raise ModuleNotFoundError(
            "het_ros needs OpenCV, which is not installed: pip install 'het_ros[opencv]', or "
            "sudo apt install python3-opencv",
            name="cv2",
        ) from None
