# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables by group of sequences, of honesty, of velocity and of prediction."""

from __future__ import annotations

from typing import Any

from het_ros.evaluation import groups, velocity, velocity_metrics
from het_ros.evaluation.groups import ALL, FIRST, LATER, Mean
from het_ros.evaluation.metrics import ON_TARGET
from het_ros.evaluation.tables import Cell, Results, Row, Table, ranked

NOTE = "Means over sequences, seeds averaged first, ± the standard error over sequences."


def tables(results: Results) -> list[Table]:
    """Every one of them that has rows."""
    found = [
        in_short(results),
        by_group(results, "auc", "AUC by group"),
        by_group(results, "p20", "Precision at 20 px by group"),
        honesty(results),
        velocities(results),
        *velocities_by_sequence(results),
        predictions(results),
    ]
    return [table for table in found if table.rows]


def _text(value: Mean | None, form: str = ".3f") -> str:
    return "-" if value is None else format(value, form)


def _values(results: Results, name: str, figure: str) -> dict[str, float]:
    return {s: of[figure] for s, of in results["trackers"][name]["sequences"].items()}


def in_short(results: Results) -> Table:
    """One row a tracker: what was seen in development first and what was not, apart."""
    present = groups.grouped(results["sequences"])
    shown = [group for group in (FIRST, LATER) if group in present] or [ALL]
    rows = []
    for name in ranked(results):
        auc, p20 = (groups.means(_values(results, name, f)) for f in ("auc", "p20"))
        fps = results["trackers"][name]["fps"]
        figures = [_text(of[group]) for group in shown for of in (auc, p20)]
        rows.append(Row.of(name, *figures, "-" if fps is None else f"{fps:.0f}"))
    head = [f"{f}, {group} ({len(present[group])})" for group in shown for f in ("AUC", "P20")]
    named = [s for group in shown if group == FIRST for s in present[group]]
    seen = f" Seen in development first: {', '.join(named)}." if named else ""
    return Table("In short", ("tracker", *head, "frames/s"), tuple(rows), NOTE + seen)


def by_group(results: Results, figure: str, title: str) -> Table:
    """One row a group, one column a tracker, the best marked."""
    names = ranked(results)
    of = {name: groups.means(_values(results, name, figure)) for name in names}
    rows = []
    for group, members in groups.grouped(results["sequences"]).items():
        best = max(of[name][group].value for name in names)
        cells = (Cell(_text(of[n][group]), of[n][group].value == best) for n in names)
        rows.append(Row((Cell(f"{group} ({len(members)})"), *cells)))
    return Table(title, ("sequences", *names), tuple(rows), NOTE)


def honesty(results: Results) -> Table:
    """One row a tracker that gives a score."""
    rows = []
    for name in ranked(results):
        h = results["trackers"][name].get("honesty")
        if h is None:
            continue
        of = h["sequences"]
        shares = ("confident", "confident_off", "off", "recall", "published_auc")
        rows.append(
            Row.of(
                name,
                *(_text(groups.over(of, key)) for key in shares),
                str(h["longest_false_lost"]),
                *(f"{h[key]:.3f}" for key in ("precision", "recall", "f", "threshold")),
                f"{h['calibration_error']:.3f}",
            )
        )
    return Table(
        "Honesty",
        (
            *("tracker", "confident", "off, of confident", "confident and off, of all"),
            *("recall of visible", "AUC without LOST", "longest false LOST"),
            *("long-term precision", "recall", "F", "at score", "calibration error"),
        ),
        tuple(rows),
        f"{NOTE} Confident: a score over 0.5; off: the box does not touch the target, or that is "
        "absent. Recall of visible: said to be TRACKING (without states: confident). AUC without "
        "LOST: frames in LOST count as no box, as nothing is published then. Longest false LOST: "
        "frames in a row, the target visible. Long-term precision, recall and F (VOT-LT): over "
        "all thresholds of the score, at the best F. Calibration error: mean distance of the "
        "score from the share of frames with an overlap over 0.5.",
    )


def velocities(results: Results) -> Table:
    """One row a tracker that gives a velocity, over all its sequences and over those that move."""
    rows = []
    for name, figures in _with_velocity(results):
        for kind, of in ((ALL, figures), ("moving", velocity.moving(figures))):
            if of:
                rows.append(_velocity_row(f"{name}, {kind} ({len(of)})", of))
    return Table(
        "Velocity",
        (
            *("tracker", "error of zero", "differences", "filter", "published"),
            *("published / zero", "change / truth's", "filter's", "lag", "filter's"),
            "within 95 %",
        ),
        tuple(rows),
        f"{NOTE} Root mean square error of a sequence against the derivative of the true centre "
        f"(quadratic fit over 11 frames), in target sides (sqrt of width times height) a second, "
        f"in frames with an overlap over {ON_TARGET:g} and not LOST; sequences with "
        f"fewer than {velocity.LEAST_FRAMES} such frames are left out. Moving: a true speed over "
        f"{velocity.MOVING:g} sides/s. Zero: publishing no motion, so the true speed itself; "
        "differences: of the boxes; filter: a constant-velocity Kalman filter on the same boxes, "
        f"acceleration {velocity_metrics.ACCELERATION:g} sides/s^2 and centre "
        f"{velocity_metrics.CENTRE:g} sides, one tuning for all. Change: from frame to "
        "frame, over the truth's. Lag: frames, by cross-correlation. Within 95 %: errors inside "
        "the bound of the velocity's covariance.",
    )


def _velocity_row(label: str, figures: dict[str, Any]) -> Row:
    errors = ("zero", "differences", "filter", "published")
    return Row.of(
        label,
        *(_text(groups.over(figures, key), ".2f") for key in errors),
        _ratio(figures, "published", "zero"),
        _ratio(figures, "change", "true_change"),
        _ratio(figures, "filter_change", "true_change"),
        *(_text(groups.over(figures, key), ".1f") for key in ("lag", "filter_lag")),
        _text(groups.over(figures, "within_95"), ".2f"),
    )


def _ratio(figures: dict[str, Any], above: str, below: str) -> str:
    """Of two means over sequences."""
    a, b = groups.over(figures, above), groups.over(figures, below)
    return "-" if a is None or b is None or b.value == 0 else f"{a.value / b.value:.2f}"


def velocities_by_sequence(results: Results) -> list[Table]:
    """One table a tracker, one row a sequence, the smallest error marked."""
    return [
        Table(
            f"Velocity of {name} by sequence",
            (
                *("sequence", "frames", "zero", "differences", "filter", "published"),
                *("change / truth's", "lag", "within 95 %"),
            ),
            tuple(_sequence_row(sequence, of) for sequence, of in figures.items()),
        )
        for name, figures in _with_velocity(results)
    ]


def _sequence_row(sequence: str, of: dict[str, Any]) -> Row:
    errors = [of[key] for key in ("zero", "differences", "filter", "published")]
    known = [error for error in errors if error is not None]
    alone = {sequence: of}
    return Row(
        (
            Cell(sequence),
            Cell(f"{of['frames']:.0f}"),
            *(Cell("-") if e is None else Cell(f"{e:.2f}", e == min(known)) for e in errors),
            Cell(_ratio(alone, "change", "true_change")),
            Cell(_text(groups.over(alone, "lag"), ".1f")),
            Cell(_text(groups.over(alone, "within_95"), ".2f")),
        )
    )


def predictions(results: Results) -> Table:
    """One row a tracker and time ahead, the smallest error marked."""
    rows = []
    names = ("stays", "two_boxes", "velocity", "own")
    for tracker, figures in _with_velocity(results):
        for seconds in next(iter(figures.values()))["ahead"]:
            means = [groups.over(figures, "ahead", seconds, name) for name in names]
            best = min((m.value for m in means if m), default=None)
            cells = (Cell(_text(m), m is not None and m.value == best) for m in means)
            rows.append(Row((Cell(tracker), Cell(seconds), *cells)))
    return Table(
        "Prediction",
        ("tracker", "s ahead", "stays where it is", "two boxes", "box + velocity", "its own"),
        tuple(rows),
        f"{NOTE} Root mean square error of the centre so much later, in target sides, from the "
        "frames of the velocity table. Two boxes: on with the difference of the last two; its "
        "own: of a tracker whose estimate has predict(dt).",
    )


def _with_velocity(results: Results) -> list[tuple[str, dict[str, Any]]]:
    trackers = results["trackers"]
    return [(n, trackers[n]["velocity"]) for n in ranked(results) if "velocity" in trackers[n]]
