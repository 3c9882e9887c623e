# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From the rows of a soak to its figures, and whether they are good enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

WARM_UP = 0.1  # of the run, and at most
LONGEST_WARM_UP = 300.0  # s: pools, caches and rings fill up
ENDS = 0.2  # of what is left, at both ends, is compared
MOST_GROWTH = 0.02  # of the memory
MOST_DRIFT = 0.15  # of the latency's p99
LONGEST_SILENCE = 2.0  # s without a status, the default of max_gap

Row = Mapping[str, Any]


def judge(rows: Sequence[Row]) -> dict[str, Any]:
    """Figures, and which bounds they keep.

    Memory, latency and files of the last fifth of the run are compared with those of the first,
    after a warm-up. Latency is looked at twice: as it is, and relative to the time that the
    camera's process took for the same work in the same seconds. Other work on the machine moves
    the first, a drift of the node moves both.

    Args:
        rows: one a stretch, in order; see :func:`het_ros.faults.soak.row_of`.

    Returns:
        ``figures`` by name, ``checks``: for each a text and whether it is met, ``passed``.

    Raises:
        ValueError: fewer than 5 rows, of which nothing can be said.
    """
    if len(rows) < 5:
        raise ValueError(f"{len(rows)} stretches are too few to judge: run it for longer")
    settled = _settled(rows)
    figures = {**_totals(rows), **_changes(settled)}
    checks = _checks(figures)
    return {
        "figures": figures,
        "checks": [{"what": what, "met": bool(met)} for what, met in checks],
        "passed": all(met for _, met in checks),
    }


def _settled(rows: Sequence[Row]) -> list[Row]:
    end = rows[-1]["time"]
    begin = min(WARM_UP * end, LONGEST_WARM_UP)
    return [row for row in rows if row["time"] > begin]


def _totals(rows: Sequence[Row]) -> dict[str, Any]:
    def total(name: str) -> int:
        return int(sum(row[name] for row in rows))

    answered = total("answered")
    return {
        "seconds": rows[-1]["time"],
        "sent": total("sent"),
        "answered": answered,
        "answered_share": answered / max(total("sent"), 1),
        "rate": total("sent") / rows[-1]["time"],
        "boxes": total("boxes"),
        "tracking": total("TRACKING"),
        "coasting": total("COASTING"),
        "lost": total("LOST"),
        "right_share": total("right") / max(total("visible"), 1),
        "longest_silence_s": max(row["silence"] for row in rows),
        "load_median": float(np.median([row["load"] for row in rows])),
        "load_max": max(row["load"] for row in rows),
    }


def _changes(rows: Sequence[Row]) -> dict[str, Any]:
    count = max(int(len(rows) * ENDS), 1)

    def column(name: str) -> NDArray[np.float64]:
        return np.array([row[name] for row in rows], float)

    def ends(values: NDArray[np.float64]) -> tuple[float, float]:
        return float(np.nanmedian(values[:count])), float(np.nanmedian(values[-count:]))

    rss, own = ends(column("rss_mb")), ends(column("own_mb"))
    p99, relative = ends(column("p99_ms")), ends(column("p99_ms") / column("probe_p99_ms"))
    cpu, files = ends(column("cpu_ms_a_frame")), column("files")
    return {
        "rss_mb": list(rss),
        "rss_growth": rss[1] / rss[0] - 1,
        "own_mb": list(own),
        "own_growth": own[1] / own[0] - 1,
        "p50_ms": list(ends(column("p50_ms"))),
        "p99_ms": list(p99),
        "p99_drift": p99[1] / p99[0] - 1,
        "p99_drift_relative": relative[1] / relative[0] - 1,
        "cpu_ms_a_frame": list(cpu),
        "files": [int(np.median(files[:count])), int(np.median(files[-count:]))],
        "files_max": int(files.max()),
        "threads": sorted({int(row["threads"]) for row in rows}),
    }


def _checks(figures: Mapping[str, Any]) -> list[tuple[str, bool]]:
    drift = min(figures["p99_drift"], figures["p99_drift_relative"])
    return [
        (
            f"memory, resident and its own, grows by less than {MOST_GROWTH:.0%}",
            max(figures["rss_growth"], figures["own_growth"]) < MOST_GROWTH,
        ),
        (f"latency p99 rises by less than {MOST_DRIFT:.0%}", drift < MOST_DRIFT),
        ("no file descriptor leaks", figures["files"][1] <= figures["files"][0]),
        ("the number of threads is constant", len(figures["threads"]) == 1),
        (
            f"never silent for {LONGEST_SILENCE:g} s",
            figures["longest_silence_s"] < LONGEST_SILENCE,
        ),
        ("there are targets tracked and hidden", 0 < figures["coasting"] < figures["tracking"]),
    ]
