# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Where a frame's time goes: the calls of one frame, timed by stage."""

from __future__ import annotations

import functools
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from het_ros.bench.footage import Footage
from het_ros.tracking import appearance, combination, flow_prior, view
from het_ros.tracking.angle_filter import AngleFilter
from het_ros.tracking.base_ensembles import NaiveBayes
from het_ros.tracking.box import Box
from het_ros.tracking.camera import CameraMotion
from het_ros.tracking.centring import Centring
from het_ros.tracking.colour import ColourModel
from het_ros.tracking.compressive import CompressiveFeatures
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.first_look import FirstLook
from het_ros.tracking.motion import AdaptiveKalman
from het_ros.tracking.ridge import RidgeEnsembles
from het_ros.tracking.scenery import Scenery
from het_ros.tracking.size import Size
from het_ros.tracking.template import TemplateWriter
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

# Stage, where its function lives, the function's name. None of them calls another of them.
_PLACES: tuple[tuple[str, Any, str], ...] = (
    ("camera", CameraMotion, "follow"),
    ("window", view, "cut_window"),
    ("channels", view, "channel_stack"),
    ("integrals", view, "integral_images"),
    ("feature maps", CompressiveFeatures, "maps"),
    ("scores", RidgeEnsembles, "score_maps"),
    ("scores", NaiveBayes, "score_maps"),
    ("colour", ColourModel, "likelihood"),
    ("colour", appearance, "cell_means"),
    ("colour", appearance, "box_means"),
    ("colour", ColourModel, "learn"),
    ("flow", flow_prior, "trace"),
    ("peak", appearance, "find_peak"),
    ("peak", appearance, "detect"),
    ("peak", combination, "weights"),
    ("peak", combination, "hypotheses"),
    ("peak", combination, "combine"),
    ("first look", FirstLook, "correction"),
    ("scenery", Scenery, "shows"),
    ("scenery", Scenery, "remember"),
    ("centring", Centring, "observe"),
    ("rotation", AngleFilter, "spectrum"),
    ("rotation", AngleFilter, "turn"),
    ("rotation", AngleFilter, "learn"),
    ("learn", RidgeEnsembles, "learn"),
    ("learn", NaiveBayes, "learn"),
    ("learn", NaiveBayes, "likelihood"),
    ("scale", TemplateWriter, "write"),
    ("scale", Size, "follow"),
    ("scale", Size, "learn"),
    ("kalman", AdaptiveKalman, "predict"),
    ("kalman", AdaptiveKalman, "correct"),
    ("kalman", AdaptiveKalman, "coast"),
)
STAGES: tuple[str, ...] = tuple(dict.fromkeys(stage for stage, _, _ in _PLACES))


@contextmanager
def timed_stages() -> Iterator[Counter[str]]:
    """Within the block every stage of every tracker adds its time, s, to the Counter given."""
    spent: Counter[str] = Counter()
    before = [(place, name, getattr(place, name)) for _, place, name in _PLACES]
    try:
        for stage, place, name in _PLACES:
            setattr(place, name, _timed(getattr(place, name), stage, spent))
        yield spent
    finally:
        for place, name, function in before:
            setattr(place, name, function)


def _timed(function: Callable[..., Any], stage: str, spent: Counter[str]) -> Callable[..., Any]:
    @functools.wraps(function)
    def timed(*args: Any, **kwargs: Any) -> Any:
        begun = time.perf_counter()
        try:
            return function(*args, **kwargs)
        finally:
            spent[stage] += time.perf_counter() - begun

    return timed


def stage_times(
    config: TrackerConfig, footage: Footage, box: Box, frames: int, warm_up: int = 5
) -> dict[str, float]:
    """Mean time of each stage in a frame, ms; "rest" is what lies between them."""
    tracker = HierarchicalEnsembleTracker(config)
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
