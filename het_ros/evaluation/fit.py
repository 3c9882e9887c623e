# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Record what the tracker knows of each frame beside whether it is right, and fit to that."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from collections.abc import Sequence as Listing
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation import logistic
from het_ros.evaluation.logistic import Examples, Quality
from het_ros.evaluation.metrics import ON_TARGET
from het_ros.evaluation.protocols import disturbed, true_box
from het_ros.evaluation.sequences import Sequence
from het_ros.tracking.box import Box
from het_ros.tracking.calibration import Calibration
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.target import Target

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]
# The regressions, by their names in Calibration.
WITHOUT, WITH = "without_network", "with_network"
WIDTHS = {WITHOUT: 6, WITH: 9}


@dataclass(frozen=True)
class Recorded:
    """One run.

    Attributes:
        sequence: its name.
        group: what is held out together with it.
        frames: how many were followed.
        rows: by regression, (n, k + 1) float64: features, then 1 where it was right, else 0.
    """

    sequence: str
    group: str
    frames: int
    rows: Mapping[str, Floats]


def recorded(
    sequence: str,
    group: str,
    frames: Iterable[tuple[Image, Box | None]],
    start: Box,
    dt: float,
    config: TrackerConfig,
    calibration: Calibration,
) -> Recorded:
    """Follow a target and record each frame but the first.

    A frame is right if the box overlaps the true one by more than half: the box that is
    published where the place was followed, else the box at the place that was not believed.

    Args:
        sequence, group: see :class:`Recorded`.
        frames: images and true boxes, px; None where the target is not visible.
        start: the box that is given, px.
        dt: time between two frames, s.
        config: of the tracker.
        calibration: what it runs with.
    """
    rows: dict[str, list[tuple[float, ...]]] = {name: [] for name in WIDTHS}
    images = iter(frames)
    target = Target(config, next(images)[0], start, calibration)
    count = 0
    for count, (image, truth) in enumerate(images, start=1):  # noqa: B007
        published = target.follow(image, dt).box
        confidence = target.confidence
        assert confidence.features is not None
        box = target.judged if confidence.unseen else published
        right = truth is not None and box.iou(truth) > ON_TARGET
        if confidence.agreement is None:
            rows[WITHOUT].append((*confidence.features.clipped(), right))
        else:
            known = *confidence.features.clipped(), *astuple(confidence.agreement)
            rows[WITH].append((*known, right))
    listed = {n: np.array(r, np.float64).reshape(-1, WIDTHS[n] + 1) for n, r in rows.items()}
    return Recorded(sequence, group, count, listed)


def given_boxes(box: Box, given: int, off: int, turn: int) -> list[tuple[int, Box]]:
    """Seeds and first boxes of a sequence's runs.

    Args:
        box: the true one.
        given: runs that start on it, from seed 0 on.
        off: runs that start on a box moved or scaled by a tenth, from seed 0 on.
        turn: number of the sequence; they take turns with the ten boxes that are off.
    """
    *moved, _, smaller, larger, _ = disturbed(box)
    boxes = [*moved, smaller, larger]
    starts = [(seed, box) for seed in range(given)]
    return starts + [(seed, boxes[(7 * turn + 3 * seed) % len(boxes)]) for seed in range(off)]


def groups_of(sequences: Listing[Sequence]) -> dict[str, str]:
    """What each sequence is held out with: those of the same pictures have one name."""
    first: dict[str, str] = {}
    return {s.name: first.setdefault(s.frames.fingerprint(), s.name) for s in sequences}


def frames_of(sequence: Sequence) -> Iterator[tuple[Image, Box | None]]:
    """Images and true boxes, one frame at a time."""
    for index, visible in enumerate(sequence.visible):
        yield sequence.frames[index], true_box(sequence, index) if visible else None


def examples(runs: Listing[Recorded], name: str) -> Examples:
    """All rows of one regression, in an order that no process has a say in."""
    ordered = sorted(runs, key=lambda run: (run.sequence, run.rows[name].tobytes()))
    rows = np.concatenate([run.rows[name] for run in ordered])
    counts = [len(run.rows[name]) for run in ordered]
    return Examples(
        rows[:, :-1],
        rows[:, -1] > 0,
        np.repeat([run.sequence for run in ordered], counts),
        np.repeat([run.group for run in ordered], counts),
    )


@dataclass(frozen=True)
class Fit:
    """One regression.

    Attributes:
        examples: what it was fitted to.
        weights: of the features, and the bias.
        predicted: (n,) by the fits that have not seen the frame's group.
        quality: of these.
    """

    examples: Examples
    weights: tuple[float, ...]
    predicted: Floats
    quality: Quality


def fitted(runs: Listing[Recorded]) -> tuple[dict[str, Fit], dict[str, str]]:
    """Each regression by its name; and of the others why there is none."""
    found, missing = {}, {}
    for name in WIDTHS:
        known = examples(runs, name)
        try:
            predicted, weights = logistic.held_out(known), logistic.fit(known)
        except ValueError as error:
            missing[name] = str(error)
            continue
        found[name] = Fit(known, weights, predicted, logistic.quality(predicted, known))
    return found, missing
