# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a frame's time goes: the calls of one frame, timed by stage."""

from __future__ import annotations

import functools
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from het_ros.bench.footage import Footage
from het_ros.evaluation.trackers import Config, tracker_of
from het_ros.tracking.bottom.colour import ColourEnsemble
from het_ros.tracking.bottom.flow import FlowEnsemble
from het_ros.tracking.bottom.network import NetworkEnsemble
from het_ros.tracking.bottom.sub_patches import SubPatchEnsembles
from het_ros.tracking.box import Box
from het_ros.tracking.features import extractor
from het_ros.tracking.features.compressive import CompressiveFeatures
from het_ros.tracking.middle.size import Size
from het_ros.tracking.paper import appearance
from het_ros.tracking.paper import target as paper
from het_ros.tracking.paper.kalman import AdaptiveKalman as PaperKalman
from het_ros.tracking.top.background import Background
from het_ros.tracking.top.confidence import Confidence
from het_ros.tracking.top.ego_motion import EgoMotion
from het_ros.tracking.top.kalman import AdaptiveKalman
from het_ros.tracking.top.redetection import Redetection

# Stage, where its function lives, the function's name. None of them calls another of them.
_PLACES: tuple[tuple[str, Any, str], ...] = (
    ("ego-motion", EgoMotion, "follow"),
    ("re-detection", Redetection, "next_place"),
    *(
        (stage, place, name)
        for place in (extractor, appearance)
        for stage, name in (
            ("window", "cut_window"),
            ("channels", "channel_stack"),
            ("integrals", "integral_images"),
        )
    ),
    ("feature maps", CompressiveFeatures, "maps"),
    ("votes", SubPatchEnsembles, "vote"),
    ("votes", paper, "score_maps"),
    ("votes", paper, "detect"),
    ("votes", paper, "combine"),
    ("votes", paper, "mean_probability"),
    ("colour", ColourEnsemble, "vote"),
    ("colour", ColourEnsemble, "learn"),
    ("flow", FlowEnsemble, "vote"),
    ("flow", FlowEnsemble, "learn"),
    ("network", NetworkEnsemble, "propose"),
    ("background", Background, "shows"),
    ("background", Background, "remember"),
    ("confidence", Confidence, "judge"),
    ("size", Size, "follow"),
    ("size", Size, "learn"),
    ("learn", SubPatchEnsembles, "learn"),
    ("learn", paper, "class_gaussians"),
    ("learn", paper, "updated"),
    *(
        ("kalman", place, name)
        for place, names in (
            (AdaptiveKalman, ("predict", "correct", "coast")),
            (PaperKalman, ("predict", "adapt", "correct")),
        )
        for name in names
    ),
)
STAGES: tuple[str, ...] = tuple(dict.fromkeys(stage for stage, _, _ in _PLACES))


@contextmanager
def timed_stages() -> Iterator[dict[str, float]]:
    """Within the block every stage of every tracker adds its time, s, to the table given."""
    spent: dict[str, float] = defaultdict(float)
    before = [(place, name, getattr(place, name)) for _, place, name in _PLACES]
    try:
        for stage, place, name in _PLACES:
            setattr(place, name, _timed(getattr(place, name), stage, spent))
        yield spent
    finally:
        for place, name, function in before:
            setattr(place, name, function)


def _timed(
    function: Callable[..., Any], stage: str, spent: dict[str, float]
) -> Callable[..., Any]:
    @functools.wraps(function)
    def timed(*args: Any, **kwargs: Any) -> Any:
        begun = time.perf_counter()
        try:
            return function(*args, **kwargs)
        finally:
            spent[stage] += time.perf_counter() - begun

    return timed


def stage_times(
    config: Config, footage: Footage, box: Box, frames: int, warm_up: int = 5
) -> dict[str, float]:
    """Mean time of each stage in a frame, ms; "rest" is what lies between them."""
    tracker = tracker_of(config)
    tracker.init(footage[0], box)
    with timed_stages() as spent:
        total = 0.0
        for i in range(1, 1 + warm_up + frames):
            if i == 1 + warm_up:
                spent.clear()
                total = 0.0
            begun = time.perf_counter()
            tracker.update(footage[i], 1 / 30)
            total += time.perf_counter() - begun
    found = {stage: 1e3 * spent[stage] / frames for stage in STAGES}
    found["rest"] = 1e3 * total / frames - sum(found.values())
    return found
