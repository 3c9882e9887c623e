# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The velocity of followed scenes against the exact one, split into the target's and camera's."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from het_ros.evaluation import groups, velocity, velocity_metrics
from het_ros.evaluation.answers import Track
from het_ros.evaluation.trackers import answer_of
from het_ros.scene.honesty import Moment

NOWHERE = (float("nan"),) * 4


def velocity_of(moments: Sequence[Moment], rate: float) -> dict[str, Any] | None:
    """The figures of ``velocity.judge``, with the exact velocity of the image as the truth.

    Beside them, in target sides a second: ``own`` and ``camera``, root mean square of the two
    parts of the true velocity, and ``in_scene``, the error against the target's own motion of an
    estimate's ``velocity_in_scene`` (px/s), None where there is none.

    Args:
        moments: of one scene, each with its truth.
        rate: frames/s.

    Returns:
        None where too few frames are on the target.
    """
    track = Track.empty(len(moments))
    for row, moment in enumerate(moments):
        track.put(row, answer_of(moment.estimate))
    truth = np.array([m.box.as_tuple() if m.box else NOWHERE for m in moments])
    own = np.array([m.motion.own if m.motion else NOWHERE[:2] for m in moments])
    camera = np.array([m.motion.camera if m.motion else NOWHERE[:2] for m in moments])
    found = velocity.judge(track, truth, 1 / rate, own + camera)
    if found is None:
        return None
    side = velocity_metrics.sides(truth)[:, None]
    use = velocity.usable(track, truth) & np.isfinite(own).all(axis=1)
    said = [getattr(m.estimate, "velocity_in_scene", None) or NOWHERE[:2] for m in moments]
    parts = {"own": own, "camera": camera, "in_scene": np.array(said, float) - own}
    return found | {name: velocity_metrics.rms((of / side)[use]) for name, of in parts.items()}


def table(scenes: Iterable[tuple[str, dict[str, Any] | None]]) -> str:
    """Markdown: a row a story, figures being means over its scenes; then a row for all."""
    by_story: dict[str, list[dict[str, Any]]] = {}
    for story, found in scenes:
        if found is not None:
            by_story.setdefault(story, []).append(found)
    every = [found for of in by_story.values() for found in of]
    if not every:
        return "No scene has enough frames on the target for a velocity."
    rows = [
        "| story | scenes | true | own part | camera's part | differences | filter | published "
        "| in the scene | change / truth's | lag | within 95 % |",
        "|---" * 12 + "|",
        *(_row(story, found) for story, found in by_story.items()),
        _row("all", every),
        "",
        "Velocity in target sides a second, root mean square of a scene, means over scenes: the "
        "true one and its two parts, and the errors of differences of the boxes, of a "
        "constant-velocity filter on them and of the published velocity against the true one, "
        "and of the velocity in the scene against the target's own part.",
    ]
    return "\n".join(rows)


def _row(label: str, found: list[dict[str, Any]]) -> str:
    mean = groups.averaged(found)
    keys = ("zero", "own", "camera", "differences", "filter", "published", "in_scene")
    cells = [label, str(len(found)), *(_text(mean[key], ".2f") for key in keys)]
    still = not mean["change"] or not mean["true_change"]
    cells.append("-" if still else f"{mean['change'] / mean['true_change']:.2f}")
    cells += [_text(mean["lag"], ".1f"), _text(mean["within_95"], ".2f")]
    return f"| {' | '.join(cells)} |"


def _text(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)
