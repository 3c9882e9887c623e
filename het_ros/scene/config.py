# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a rendered scene is made from."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.scene.stories import STORIES
from het_ros.tracking.parameter import check_parameters, parameter


@dataclass(frozen=True)
class SceneConfig:
    """Everything that a scene depends on: the same configuration gives the same pixels.

    Raises:
        ValueError: a value is of the wrong type or outside its range.
    """

    story: str = parameter(
        "follow_walk", "what happens (het_ros.scene.STORIES)", choices=tuple(STORIES)
    )
    seed: int = parameter(0, "seed of street, clothes, gait, shake and noise", low=0, high=2**31)
    width: int = parameter(640, "image width", unit="px", low=64, high=4096)
    height: int = parameter(480, "image height", unit="px", low=48, high=4096)
    rate: float = parameter(20.0, "frames a second", unit="1/s", low=1.0, high=240.0)
    seconds: float = parameter(
        0.0, "length of the video; 0 takes the story's own", unit="s", low=0.0, high=3600.0
    )
    noise: float = parameter(
        1.6, "standard deviation of the sensor's noise at mid grey", unit="grey levels",
        low=0.0, high=30.0,
    )  # fmt: skip
    shake: float = parameter(1.0, "strength of the camera's shake", low=0.0, high=5.0)
    exposure: float = parameter(
        0.008, "time the shutter is open; smears a panning camera", unit="s", low=0.0, high=0.1
    )

    def __post_init__(self) -> None:
        check_parameters(self)
