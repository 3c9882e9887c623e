# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The plots of a comparison as PNG: success, precision, attributes, calibration, speed."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from het_ros.evaluation.drawing import Colour
from het_ros.evaluation.metrics import ERROR_THRESHOLDS, OVERLAP_THRESHOLDS
from het_ros.evaluation.tables import Results, ranked

mpl.use("Agg")
_STYLES = ("-", "--", "-.", ":")


def plots(results: Results, palette: Mapping[str, Colour]) -> dict[str, bytes]:
    """Every plot that the results allow, PNG by name, in the order of a report."""
    trackers = results["trackers"]
    drawn: dict[str, Callable[[Axes], None]] = {
        "success": lambda a: _curves(a, results, palette, "success_curve", "auc"),
        "precision": lambda a: _curves(a, results, palette, "precision_curve", "p20"),
        "speed": lambda a: _speed(a, results, palette),
    }
    if any(t["attributes"] for t in trackers.values()):
        drawn["attributes"] = lambda a: _attributes(a, results, palette)
    if any("calibration" in t for t in trackers.values()):
        drawn["calibration"] = lambda a: _calibration(a, results, palette)
    wide = {"attributes": (11, 4.2)}
    return {name: _png(draw, wide.get(name, (5.6, 4.4))) for name, draw in drawn.items()}


def _png(draw: Callable[[Axes], None], size: tuple[float, float]) -> bytes:
    figure = Figure(figsize=size, dpi=110, layout="constrained")
    draw(figure.subplots())
    out = io.BytesIO()
    figure.savefig(out, format="png")
    return out.getvalue()


def _colour(palette: Mapping[str, Colour], name: str) -> tuple[float, ...]:
    return tuple(value / 255 for value in palette[name])


def _curves(
    axes: Axes, results: Results, palette: Mapping[str, Colour], curve: str, figure: str
) -> None:
    success = curve == "success_curve"
    thresholds = OVERLAP_THRESHOLDS if success else ERROR_THRESHOLDS
    order = sorted(results["trackers"].items(), key=lambda item: -item[1][figure])
    for rank, (name, t) in enumerate(order):
        axes.plot(
            thresholds,
            t[curve],
            _STYLES[rank % len(_STYLES)],
            color=_colour(palette, name),
            label=f"{name} [{t[figure]:.3f}]",
        )
    axes.set(ylim=(0, 1), xlim=(0, thresholds[-1]))
    if success:
        axes.set(xlabel="overlap threshold", ylabel="success rate", title="Success [AUC]")
    else:
        axes.axvline(20, color="0.8", linewidth=1, zorder=0)
        axes.set(xlabel="error threshold, px", ylabel="precision", title="Precision [at 20 px]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)


def _attributes(axes: Axes, results: Results, palette: Mapping[str, Colour]) -> None:
    names = ranked(results)
    tags = list(results["trackers"][names[0]]["attributes"])
    width = 0.85 / len(names)
    for k, name in enumerate(names):
        found = results["trackers"][name]["attributes"]
        heights = [found[tag]["auc"] for tag in tags]
        axes.bar(
            np.arange(len(tags)) + k * width,
            heights,
            width,
            color=_colour(palette, name),
            label=name,
        )
    counts = results["trackers"][names[0]]["attributes"]
    labels = [f"{tag}\n({counts[tag]['sequences']})" for tag in tags]
    axes.set_xticks(np.arange(len(tags)) + 0.425 - width / 2, labels)
    axes.set(ylabel="AUC", title="AUC by attribute (number of sequences)")
    axes.grid(axis="y", alpha=0.3)
    axes.legend(fontsize=8, ncols=min(len(names), 5))


def _calibration(axes: Axes, results: Results, palette: Mapping[str, Colour]) -> None:
    axes.plot([0, 1], [0, 1], color="0.7", linewidth=1)
    for name, t in results["trackers"].items():
        if "calibration" not in t:
            continue
        bins = t["calibration"]["bins"]
        points = [b["score"] for b in bins], [b["right"] for b in bins]
        label = f"{name} [{t['calibration']['error']:.3f}]"
        axes.plot(*points, "o-", color=_colour(palette, name), label=label)
    axes.set(xlabel="score", ylabel="share of frames with overlap > 0.5", xlim=(0, 1), ylim=(0, 1))
    axes.set_title("Calibration of the score [expected error]")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)


def _speed(axes: Axes, results: Results, palette: Mapping[str, Colour]) -> None:
    for name, t in results["trackers"].items():
        if t["fps"]:
            axes.plot(t["fps"], t["auc"], "o", color=_colour(palette, name), markersize=9)
            axes.annotate(
                name, (t["fps"], t["auc"]), (6, 4), textcoords="offset points", fontsize=8
            )
    axes.set(xscale="log", xlabel="frames/s, one thread", ylabel="AUC", title="Accuracy and speed")
    axes.margins(x=0.15, y=0.1)
    axes.grid(alpha=0.3)
