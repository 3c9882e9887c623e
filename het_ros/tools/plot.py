# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""track.png: a strip of frames, and what the tracker said over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from het_ros.evaluation.velocity_metrics import derivative
from het_ros.tools.drawing import STATE_COLOURS
from het_ros.tools.results import Row
from het_ros.tools.summary import Truth
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import State

FIGURE_WIDTH = 16.0  # inches
CAPTIONS_ABOVE = 0.5  # inch
PANEL_HEIGHT = 1.7  # inches
NAN_BOX = (np.nan,) * 4


def plot_track(
    path: Path | str,
    rows: Sequence[Row],
    truth: Sequence[Truth],
    strip: Sequence[tuple[int, NDArray[np.uint8]]],
    title: str,
) -> None:
    """Draw the strip of frames above the plots of centre, speed, score, and error if known.

    Args:
        path: PNG to write.
        rows: n answers in the order of time.
        truth: what is known of the n frames.
        strip: annotated frames, (H, W, 3) uint8 BGR of one size, with their index in ``rows``.
        title: text on top.
    """
    panels = [_plot_centre, _plot_speed, _plot_score]
    if any(true.box for true in truth):
        panels += [_plot_overlap, _plot_error]
    columns = max(-(-len(strip) // 2), 1)
    strip_rows = 2 if len(strip) > 1 else 1
    tall = _aspect(strip) * FIGURE_WIDTH / columns + 0.2
    heights = [tall] * strip_rows + [PANEL_HEIGHT] * len(panels)
    figure = Figure(figsize=(FIGURE_WIDTH, sum(heights) + CAPTIONS_ABOVE), layout="constrained")
    figure.suptitle(title)
    above, below = figure.subfigures(
        2, 1, height_ratios=(sum(heights[:strip_rows]), sum(heights[strip_rows:]))
    )
    start = rows[0].stamp if rows else 0
    _show_strip(above.subplots(strip_rows, columns, squeeze=False).ravel(), rows, strip, start)
    time = np.array([(row.stamp - start) * 1e-9 for row in rows])
    # Lines run on through frames without an answer; the background says where those are.
    answered = [index for index, row in enumerate(rows) if row.state is not None]
    told, true = [rows[index] for index in answered], [truth[index] for index in answered]
    axes = below.subplots(len(panels), 1, sharex=True, squeeze=False).ravel()
    for axis, panel in zip(axes, panels, strict=True):
        _shade_states(axis, time, rows)
        panel(axis, time[answered], told, true)
        axis.grid(alpha=0.3)
        axis.margins(x=0.01)
    axes[-1].set_xlabel("time / s")
    figure.savefig(path, dpi=100)


def _aspect(strip: Sequence[tuple[int, NDArray[np.uint8]]]) -> float:
    return strip[0][1].shape[0] / strip[0][1].shape[1] if strip else 0.1


def _show_strip(
    axes: NDArray[np.object_],
    rows: Sequence[Row],
    strip: Sequence[tuple[int, NDArray[np.uint8]]],
    start: int,
) -> None:
    for axis in axes:
        axis.set_axis_off()
    for axis, (index, image) in zip(axes, strip, strict=False):
        axis.imshow(image[..., ::-1], aspect="equal")
        axis.set_title(_strip_caption(rows[index], index, start), fontsize=9)


def _strip_caption(row: Row, index: int, start: int) -> str:
    text = f"{index}: {(row.stamp - start) * 1e-9:.1f} s, "
    if row.state is None:
        return text + "no answer"
    return text + row.state.value + ("" if row.score is None else f" {row.score:.2f}")


def _shade_states(axis: Axes, time: NDArray[np.float64], rows: Sequence[Row]) -> None:
    """Colour the background wherever the target was not tracked."""
    edges = np.append(time, time[-1] if len(time) else 0.0)
    for state in (State.COASTING, State.LOST, State.IDLE, None):
        there = np.array([row.state is state for row in rows], bool)
        if there.any():
            blue, green, red = STATE_COLOURS[state]
            axis.fill_between(
                edges,
                0,
                1,
                where=np.append(there, there[-1]) | np.append(False, there),
                transform=axis.get_xaxis_transform(),
                color=(red / 255, green / 255, blue / 255, 0.25),
                linewidth=0,
                label=state.value if state else "no answer",
            )


def _boxes(boxes: Sequence[Box | None]) -> NDArray[np.float64]:
    """(n, 4) boxes, NaN where there is none."""
    return np.array([box.as_tuple() if box else NAN_BOX for box in boxes]).reshape(-1, 4)


def _centres(boxes: Sequence[Box | None]) -> NDArray[np.float64]:
    array = _boxes(boxes)
    return array[:, :2] + array[:, 2:] / 2


def _plot_centre(
    axis: Axes, time: NDArray[np.float64], rows: Sequence[Row], truth: Sequence[Truth]
) -> None:
    if any(true.box for true in truth):
        for values, name in zip(_centres([true.box for true in truth]).T, "xy", strict=True):
            axis.plot(time, values, "k:", linewidth=1, label=f"{name}, truth")
    for values, name in zip(_centres([row.box for row in rows]).T, "xy", strict=True):
        axis.plot(time, values, linewidth=1.4, label=name)
    axis.set_ylabel("centre / px")
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)


def _plot_speed(
    axis: Axes, time: NDArray[np.float64], rows: Sequence[Row], truth: Sequence[Truth]
) -> None:
    speed = [np.hypot(*row.velocity) if row.velocity else np.nan for row in rows]
    known = [row.velocity_deviation or np.nan for row in rows]
    low, high = np.maximum(np.subtract(speed, known), 0), np.add(speed, known)
    axis.fill_between(time, low, high, color="C2", alpha=0.25, linewidth=0, label="deviation")
    if len(time) > 1 and any(true.box for true in truth):
        step = float(np.median(np.diff(time)))
        true = derivative(_centres([frame.box for frame in truth]), step)
        axis.plot(time, np.hypot(*true.T), "k:", linewidth=1, label="truth")
    axis.plot(time, speed, "C2", linewidth=1.4, label="speed")
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
    axis.set_ylabel("speed / px/s")


def _plot_score(
    axis: Axes, time: NDArray[np.float64], rows: Sequence[Row], truth: Sequence[Truth]
) -> None:
    if any(true.visible < 1 for true in truth):
        axis.plot(time, [true.visible for true in truth], "k:", linewidth=1, label="visible part")
    scores = [np.nan if row.score is None else row.score for row in rows]
    axis.plot(time, scores, "C3", linewidth=1.4, label="score")
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
    axis.set_ylim(-0.03, 1.03)
    axis.set_ylabel("score")


def _plot_overlap(
    axis: Axes, time: NDArray[np.float64], rows: Sequence[Row], truth: Sequence[Truth]
) -> None:
    overlap = [
        row.box.iou(true.seen_box) if row.box and true.seen_box else np.nan
        for row, true in zip(rows, truth, strict=True)
    ]
    axis.plot(time, overlap, "C0", linewidth=1.4)
    axis.set_ylim(-0.03, 1.03)
    axis.set_ylabel("IoU")


def _plot_error(
    axis: Axes, time: NDArray[np.float64], rows: Sequence[Row], truth: Sequence[Truth]
) -> None:
    true = _centres([frame.seen_box for frame in truth])
    error = np.hypot(*(_centres([row.box for row in rows]) - true).T)
    axis.plot(time, error, "C1", linewidth=1.4)
    axis.set_ylim(bottom=0)
    axis.set_ylabel("centre error / px")
