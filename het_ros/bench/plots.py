# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The bench in pictures, as PNG."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

mpl.use("Agg")
Bench = Mapping[str, Any]


def plots(bench: Bench) -> dict[str, bytes]:
    """Every plot that the figures allow, PNG by name."""
    drawn: dict[str, Callable[[Figure], None]] = {
        "core": lambda figure: _core(figure.subplots(), bench["core"]),
        "stages": lambda figure: _stages(figure.subplots(), bench["stages"]),
        "scaling": lambda figure: _scaling(figure, bench["scaling"]),
        "node": lambda figure: _node(figure.subplots(), bench["node"]),
    }
    return {name: _png(draw, name) for name, draw in drawn.items() if bench.get(name)}


def _png(draw: Callable[[Figure], None], name: str) -> bytes:
    size = {"scaling": (10, 7), "node": (10, 4)}.get(name, (7, 4))
    figure = Figure(figsize=size, dpi=110, layout="constrained")
    draw(figure)
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return out.getvalue()


def _core(axes: Axes, core: Bench) -> None:
    names = sorted(core["trackers"], key=lambda name: -core["trackers"][name]["p50_ms"])
    rows = np.arange(len(names))
    for percent, shade in ((99, "0.85"), (95, "0.7"), (50, "tab:blue")):
        widths = [core["trackers"][name][f"p{percent}_ms"] for name in names]
        axes.barh(rows, widths, color=shade, label=f"p{percent}")
    axes.set_yticks(rows, names)
    axes.set(xscale="log", xlabel="time of a frame, ms", title="Core and peers, same frames")
    axes.legend()


def _stages(axes: Axes, stages: Bench) -> None:
    left = np.zeros(len(stages))
    colours = mpl.colormaps["tab20"]
    for k, stage in enumerate(next(iter(stages.values()))):
        widths = np.array([max(times[stage], 0) for times in stages.values()])
        axes.barh(list(stages), widths, left=left, color=colours(k), label=stage)
        left += widths
    axes.set(xlabel="ms a frame", title="Where a frame's time goes")
    axes.legend(fontsize=8, ncols=2, loc="center left", bbox_to_anchor=(1, 0.5))


def _scaling(figure: Figure, scaling: Bench) -> None:
    curves = ("target", "image", "sub_patches", "features")
    for axes, curve in zip(figure.subplots(2, 2).flat, curves, strict=True):
        cases = scaling[curve]["cases"]
        sizes = [case["size"] for case in cases]
        times = [case["p50_ms"] for case in cases]
        axes.plot(sizes, times, "o-")
        axes.set(xscale="log", ylim=(0, 1.2 * max(times)), ylabel="p50, ms")
        axes.set_xticks(sizes, [case["name"] for case in cases], rotation=20)
        axes.minorticks_off()
        axes.set_title(f"{curve}: exponent {scaling[curve]['exponent']:+.2f}")
        axes.grid(alpha=0.3)


def _node(axes: Axes, node: Bench) -> None:
    groups = (
        ("core alone", lambda case: case["core"]),
        ("node, its own time", lambda case: case["own"]),
        ("image to box, two processes", lambda case: case["latency"]),
        ("image to box, one process", lambda case: case["one_process"]["latency"]),
    )
    places = np.arange(len(node))
    for k, (label, figures) in enumerate(groups):
        p50 = [figures(case)["p50_ms"] for case in node.values()]
        p95 = [figures(case)["p95_ms"] for case in node.values()]
        bars = axes.bar(places + 0.2 * k, p95, 0.18, alpha=0.4)
        colour = bars.patches[0].get_facecolor()
        axes.bar(places + 0.2 * k, p50, 0.18, color=(*colour[:3], 1), label=label)
    axes.set_xticks(places + 0.3, list(node))
    axes.set(ylabel="ms, p50 (full) and p95 (pale)", title="Node")
    axes.legend(fontsize=8)
