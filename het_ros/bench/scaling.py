# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How the cost of a frame grows with the target, the image, Q and the number of features."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from tqdm import tqdm

from het_ros.bench.figures import exponent, factor
from het_ros.bench.footage import Footage, middle
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import State
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

TARGETS = ((12, 30), (24, 60), (60, 150), (120, 300), (240, 600), (600, 1500))
IMAGES = ((320, 240), (640, 480), (1280, 720), (1920, 1080), (3840, 2160))
SUB_PATCHES = (5, 11, 22, 44)
FEATURES = (75, 150, 300, 600)
TARGET_IN_IMAGES = (48, 120)  # px, where the image is what changes
BLOCK = 10  # frames that a case gets in a row


@dataclass(frozen=True)
class Case:
    """One point of a curve.

    Attributes:
        name: what it is called, e.g. "12x30".
        size: what the exponent is over: side of the target or image, px, or a number.
        config: of its tracker.
        footage: its frames.
        target: (w, h), px, in the middle of the first frame.
    """

    name: str
    size: float
    config: TrackerConfig
    footage: Footage
    target: tuple[int, int]


def cases_of(quick: bool = False) -> dict[str, list[Case]]:
    """The curves: "target", "image", "sub_patches" and "features".

    Args:
        quick: with images no larger than 1280x720 and targets that fit into them, to try it out.
    """
    config = TrackerConfig()
    images = IMAGES[:3] if quick else IMAGES
    footages = {size: Footage(*size) for size in images}
    largest = footages[images[-1]]
    targets = TARGETS[:4] if quick else TARGETS
    usual = footages[(640, 480)]

    def changed(name: str, value: int) -> Case:
        new = dataclasses.replace(config, **{name: value})
        return Case(str(value), value, new, usual, TARGET_IN_IMAGES)

    return {
        "target": [
            Case(f"{w}x{h}", float(np.sqrt(w * h)), config, largest, (w, h)) for w, h in targets
        ],
        "image": [
            Case(f"{w}x{h}", float(np.sqrt(w * h)), config, footages[w, h], TARGET_IN_IMAGES)
            for w, h in images
        ],
        "sub_patches": [changed("sub_patches", value) for value in SUB_PATCHES],
        "features": [changed("features", value) for value in FEATURES],
    }


def scaling(
    curves: Mapping[str, Sequence[Case]], frames: int, quiet: bool = False
) -> dict[str, Any]:
    """Time every case; the cases of a curve take turns, so that all see the same machine.

    Returns:
        By curve: ``cases`` (name, size, median ``p50_ms``, share of frames ``tracking``) and
        the ``exponent``; ``target_factor`` (largest over smallest time) and ``image_factor``
        (the same from 640x480 on).
    """
    found: dict[str, Any] = {}
    for curve, cases in tqdm(curves.items(), unit="curve", desc="scaling", disable=quiet):
        points = _timed(cases, frames)
        times = [point["p50_ms"] for point in points]
        found[curve] = {
            "cases": points,
            "exponent": exponent([case.size for case in cases], times),
        }
    found["target_factor"] = factor([p["p50_ms"] for p in found["target"]["cases"]])
    found["image_factor"] = factor(
        [p["p50_ms"] for p in found["image"]["cases"] if p["name"] != "320x240"]
    )
    return found


def _timed(cases: Sequence[Case], frames: int) -> list[dict[str, Any]]:
    trackers = [_started(case) for case in cases]
    times = np.empty((len(cases), frames))
    tracking = np.zeros(len(cases))
    for first in range(0, frames, BLOCK):
        for k, (case, tracker) in enumerate(zip(cases, trackers, strict=True)):
            for i in range(first, min(first + BLOCK, frames)):
                image = case.footage[i + 1]
                begun = time.perf_counter()
                estimate = tracker.update(image, 1 / 30)
                times[k, i] = time.perf_counter() - begun
                tracking[k] += estimate.state is State.TRACKING
    return [
        {
            "name": case.name,
            "size": case.size,
            "p50_ms": float(1e3 * np.median(times[k])),
            "tracking": float(tracking[k] / frames),
        }
        for k, case in enumerate(cases)
    ]


def _started(case: Case) -> HierarchicalEnsembleTracker:
    tracker = HierarchicalEnsembleTracker(case.config)
    tracker.init(case.footage[0], middle(case.footage, case.target))
    return tracker
