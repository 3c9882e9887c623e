# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""soak.png: what the tracker's process held and took, over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

Row = Mapping[str, Any]


def plot(rows: Sequence[Row], path: Path) -> None:
    """Draw memory, latency, processor time, files and threads, and the states."""
    figure = Figure(figsize=(11, 12), dpi=100, layout="constrained")
    axes = figure.subplots(5, 1, sharex=True)
    minutes = _column(rows, "time") / 60
    for axis, draw in zip(axes, (_memory, _latency, _work, _counts, _states), strict=True):
        draw(axis, minutes, rows)
        axis.grid(alpha=0.3)
        axis.legend(loc="upper left", fontsize="small", ncols=3)
    axes[-1].set_xlabel("min")
    figure.savefig(path)


def _column(rows: Sequence[Row], name: str) -> NDArray[np.float64]:
    return np.array([row[name] for row in rows], float)


def _memory(axis: Axes, minutes: NDArray[np.float64], rows: Sequence[Row]) -> None:
    axis.plot(minutes, _column(rows, "rss_mb"), label="resident memory")
    axis.plot(minutes, _column(rows, "own_mb"), label="its own part (heap, stacks)")
    axis.set_ylim(bottom=0)
    axis.set_ylabel("MB")


def _latency(axis: Axes, minutes: NDArray[np.float64], rows: Sequence[Row]) -> None:
    for name in ("p50", "p99"):
        axis.plot(minutes, _column(rows, f"{name}_ms"), label=f"node's latency {name}")
    axis.plot(minutes, _column(rows, "probe_p99_ms"), lw=0.8, label="decoding in the camera p99")
    axis.set_ylim(bottom=0)
    axis.set_ylabel("ms")


def _work(axis: Axes, minutes: NDArray[np.float64], rows: Sequence[Row]) -> None:
    axis.plot(minutes, _column(rows, "cpu_ms_a_frame"), label="processor time a frame, ms")
    axis.plot(minutes, _column(rows, "load"), label="load average of the machine")
    axis.set_ylim(bottom=0)


def _counts(axis: Axes, minutes: NDArray[np.float64], rows: Sequence[Row]) -> None:
    axis.plot(minutes, _column(rows, "files"), label="open files")
    axis.plot(minutes, _column(rows, "threads"), label="threads")
    axis.set_ylim(bottom=0)


def _states(axis: Axes, minutes: NDArray[np.float64], rows: Sequence[Row]) -> None:
    sent = _column(rows, "sent")
    for name in ("answered", "TRACKING", "COASTING", "LOST"):
        axis.plot(minutes, _column(rows, name) / sent, lw=0.8, label=name)
    axis.set_ylabel("share of frames")
    axis.set_ylim(0, 1.05)
