# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The arithmetic of the bench: percentiles, ratios, exponents; and which figures there must be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

# What bench.json holds at least, by dotted name.
REQUIRED = (
    "core.speed_over_csrt",
    "core.paper_speed_over_csrt",
    "core.p50_ms",
    "core.p99_over_p50",
    "core.ratio_to_floor",
    "scaling.target_factor",
    "scaling.image_factor",
    "node.1080p30.dropped",
    "node.1080p30.added_p95_ms",
    "start.seconds",
    "start.rss_mb",
)


def percentiles(seconds: ArrayLike) -> dict[str, float]:
    """p50, p95 and p99 in ms of times in s; NaN (not measured) is left out, of none all is NaN.

    >>> percentiles([0.001, 0.001, 0.001])
    {'p50_ms': 1.0, 'p95_ms': 1.0, 'p99_ms': 1.0}
    """
    times = np.asarray(seconds, np.float64)
    times = times[~np.isnan(times)]
    if not times.size:
        return {f"p{percent}_ms": float("nan") for percent in (50, 95, 99)}
    return {
        f"p{percent}_ms": float(1e3 * np.percentile(times, percent)) for percent in (50, 95, 99)
    }


def speed_over(ours: Sequence[ArrayLike], theirs: Sequence[ArrayLike]) -> float:
    """How many times faster we are: median over sequences of the ratio of median times.

    Args:
        ours: for each sequence our times, s.
        theirs: for the same sequences the peer's; NaN where it failed. Sequences with nothing
            but failures are left out.

    Returns:
        The factor; NaN where no sequence can be compared.
    """
    ratios = [
        np.nanmedian(b) / np.nanmedian(a)
        for a, b in zip(ours, theirs, strict=True)
        if not np.isnan(a).all() and not np.isnan(b).all()
    ]
    return float(np.median(ratios)) if ratios else float("nan")


def exponent(sizes: Sequence[float], times: Sequence[float]) -> float:
    """K of the power law time = c size^k that fits best, by least squares of the logarithms.

    >>> round(exponent([1, 2, 4], [3, 6, 12]), 6)
    1.0
    """
    return float(np.polyfit(np.log(sizes), np.log(times), 1)[0])


def factor(times: Sequence[float]) -> float:
    """The largest of some times over the smallest."""
    return float(max(times) / min(times))


def lookup(bench: Mapping[str, Any], name: str) -> Any:
    """The figure of a dotted name, or None.

    >>> lookup({"core": {"p50_ms": 4.0}}, "core.p50_ms")
    4.0
    """
    place: Any = bench
    for part in name.split("."):
        if not isinstance(place, Mapping) or part not in place:
            return None
        place = place[part]
    return place


def missing(bench: Mapping[str, Any]) -> list[str]:
    """Those of :data:`REQUIRED` that are not there or are no finite number."""
    values = {name: lookup(bench, name) for name in REQUIRED}
    return [
        name
        for name, value in values.items()
        if not isinstance(value, int | float) or not np.isfinite(value)
    ]


def plain(value: Any) -> Any:
    """A value for JSON: what was not measured (NaN, infinite) is None.

    >>> plain({"a": [1.0, float("nan")]})
    {'a': [1.0, None]}
    """
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
