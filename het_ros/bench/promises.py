# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What the tracker is held to, and whether a run shows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from het_ros.bench.figures import lookup


@dataclass(frozen=True)
class Promise:
    """One bound on one figure.

    Attributes:
        text: what it means.
        figure: its dotted name in bench.json.
        bound: the limit.
        least: whether the bound is the least that is allowed, or else the most.
    """

    text: str
    figure: str
    bound: float
    least: bool = False

    def kept(self, bench: Mapping[str, Any]) -> bool | None:
        """Whether a run shows it; None where it was not measured."""
        value = lookup(bench, self.figure)
        if value is None or value != value:
            return None
        return bool(value >= self.bound if self.least else value <= self.bound)


PROMISES = (
    Promise("speed over CSRT, default", "core.speed_over_csrt", 3, least=True),
    Promise("speed over CSRT, the paper's configuration", "core.paper_speed_over_csrt", 5, True),
    Promise("speed over CSRT, with a network", "core.network.speed_over_csrt", 2.5, least=True),
    Promise(
        "two threads: time over that of the slower of network and the rest",
        "core.network.time_over_slower",
        1.15,
    ),
    Promise("p99 over p50 of a frame", "core.p99_over_p50", 2),
    Promise("smallest to largest target, cost by a factor of", "scaling.target_factor", 1.5),
    Promise("640x480 to 3840x2160, cost by a factor of", "scaling.image_factor", 1.5),
    Promise("frames dropped at 1080p, 30 frames/s", "node.1080p30.dropped", 0),
    Promise("node's own p95 less the core's, ms", "node.1080p30.added_p95_ms", 3),
    Promise("ratio to the floor", "core.ratio_to_floor", 4),
)


def rows(bench: Mapping[str, Any]) -> list[list[str]]:
    """What, measured, bound, kept: the cells of a table."""
    found = []
    for promise in PROMISES:
        value = lookup(bench, promise.figure)
        kept = {True: "yes", False: "**no**", None: "not measured"}[promise.kept(bench)]
        sign = "at least" if promise.least else "at most"
        measured = "-" if value is None else f"{value:.2f}".removesuffix(".00")
        found.append([promise.text, measured, f"{sign} {promise.bound:g}", kept])
    return found
