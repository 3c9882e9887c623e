# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tables of a report, once for Markdown and once for HTML."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

Results = dict[str, Any]


@dataclass(frozen=True)
class Cell:
    """One cell: its text, and whether it is the best of its row."""

    text: str
    best: bool = False


@dataclass(frozen=True)
class Row:
    """One row of cells; ``ours`` sets it apart from published ones."""

    cells: tuple[Cell, ...]
    ours: bool = False

    @classmethod
    def of(cls, *texts: str) -> Row:
        """A row of plain cells."""
        return cls(tuple(Cell(text) for text in texts))


@dataclass(frozen=True)
class Table:
    """A table with its title, and a note on how to read it."""

    title: str
    head: tuple[str, ...]
    rows: tuple[Row, ...]
    note: str = ""

    def markdown(self) -> str:
        """The table without its title, in Markdown."""
        lines = [_line(self.head), "|---" * len(self.head) + "|"]
        for row in self.rows:
            cells = [f"**{c.text}**" if c.best else c.text for c in row.cells]
            if row.ours:
                cells[0] = f"**{cells[0]}**"
            lines.append(_line(cells))
        return "\n".join(lines)


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _row(*texts: str, ours: bool = False) -> Row:
    return Row(tuple(Cell(text) for text in texts), ours)


def ranked(results: Results) -> list[str]:
    """The trackers' names, best AUC first."""
    trackers = results["trackers"]
    return sorted(trackers, key=lambda name: -trackers[name]["auc"])


def tables(results: Results, comparison: dict[str, Any] | None = None) -> list[Table]:
    """Every table that the results allow."""
    found = [summary(results)]
    if results["protocol"] == "realtime":
        found.append(real_time(results))
    if results["protocol"] == "restart":
        found.append(restarts(results))
    found.append(by_sequence(results, "auc", "AUC by sequence"))
    found.append(by_sequence(results, "p20", "Precision at 20 px by sequence"))
    found.append(by_attribute(results))
    found.append(states(results))
    if comparison:
        found += published(comparison)
    return [table for table in found if table.rows]


def summary(results: Results) -> Table:
    """One row a tracker."""
    rows = []
    for name in ranked(results):
        t = results["trackers"][name]
        rows.append(
            _row(
                name,
                _with_error(t, "auc"),
                _with_error(t, "p20"),
                f"{t['norm_precision']:.3f}",
                f"{t['mean_overlap']:.3f}",
                _number(t["fps"], ".1f"),
                _number(t["p99_ms"], ".1f"),
                _seeds(t),
                str(len(t["errors"])),
            )
        )
    timed = results["timing"]
    speed = (
        f"Speed: the first {timed['frames']} updates on each sequence, on one thread, trackers "
        f"side by side (highest load average of the machine at that time: {timed['load']:.1f})."
        if timed["frames"]
        else "Speed: a rough one, from the scored runs, which shared the processor."
    )
    head = ("tracker", "AUC", "P20", "norm. precision", "mean overlap", "frames/s", "p99 ms")
    return Table(
        "Trackers",
        (*head, "seeds", "failed runs"),
        tuple(rows),
        "Means over sequences, seeds averaged first, ± the standard error over sequences. Seeds: "
        f"in brackets the standard deviation of their AUC. {speed}",
    )


def _with_error(figures: dict[str, Any], key: str) -> str:
    error = figures["groups"][key]["all"]["standard_error"]
    text = f"{figures[key]:.3f}"
    return text if error is None else f"{text} ± {error:.3f}"


def _seeds(figures: dict[str, Any]) -> str:
    count = figures["seeds"]
    return f"{count} (± {figures['auc_std']:.3f})" if count > 1 else str(count)


def _number(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)


def by_sequence(results: Results, figure: str, title: str) -> Table:
    """One row a sequence, one column a tracker, the best marked."""
    names = ranked(results)
    of = {n: results["trackers"][n]["sequences"] for n in names}
    rows = [
        _compared(sequence, [of[n][sequence][figure] for n in names])
        for sequence in results["sequences"]
    ]
    return Table(title, ("sequence", *names), tuple(rows))


def by_attribute(results: Results) -> Table:
    """One row an attribute, one column a tracker, the best AUC marked."""
    names = ranked(results)
    of = {n: results["trackers"][n]["attributes"] for n in names}
    tags = of[names[0]]
    rows = [
        _compared(f"{tag} ({found['sequences']})", [of[n][tag]["auc"] for n in names])
        for tag, found in tags.items()
    ]
    note = "In brackets the number of sequences."
    return Table("AUC by attribute", ("attribute", *names), tuple(rows), note)


def _compared(label: str, values: list[float]) -> Row:
    best = max(values)
    return Row((Cell(label), *(Cell(f"{v:.3f}", v == best) for v in values)))


def states(results: Results) -> Table:
    """What trackers say of themselves: state, score, covariance."""
    rows = []
    for name in ranked(results):
        t = results["trackers"][name]
        if "state" not in t:
            continue
        s, c, n = t["state"], t.get("calibration", {}), t.get("nis", {})
        rows.append(
            _row(
                name,
                f"{s['precision']:.3f}",
                f"{s['recall']:.3f}",
                f"{s['f']:.3f}",
                f"{s['off_target']:.3f}",
                f"{s['false_lost']} of {s['visible_frames']} ({s['longest_false_lost']})",
                f"{s['missed_lost']} of {s['absent_frames']}",
                f"{s['reacquired']} of {s['reappearances']}",
                _number(s["reacquisition_frames"], ".0f"),
                _number(c.get("error"), ".3f"),
                _number(n.get("mean"), ".2f"),
                _number(n.get("within_95"), ".2f"),
            )
        )
    return Table(
        "Did it know?",
        (
            *("tracker", "precision", "recall", "F", "off target", "false LOST (longest)"),
            *("missed LOST", "re-acquired", "after frames", "score error", "NIS", "within 95 %"),
        ),
        tuple(rows),
        "Precision, recall and F of TRACKING as the answer to 'is the target visible?'; off "
        "target: share of TRACKING frames whose box does not touch the visible target; false "
        "LOST: LOST though it was visible, in all runs together, and the longest row of such "
        "frames; missed LOST: TRACKING while absent. Where no sequence has an absence, precision "
        "is 1 for everybody and F says only how often a tracker gave up. Score "
        "error: mean distance from the calibration's diagonal; NIS: 2 is consistent, and 0.95 of "
        "the frames within its 95 % bound.",
    )


def real_time(results: Results) -> Table:
    """One row a tracker, three columns a camera."""
    names = ranked(results)
    rates = list(results["trackers"][names[0]]["realtime"])
    head = [text for r in rates for text in (f"AUC at {r}/s", f"P20 at {r}/s", "frames seen")]
    rows = []
    for name in names:
        of = results["trackers"][name]["realtime"]
        keys = ("auc", "p20", "frames_seen")
        rows.append(_row(name, *(f"{of[r][k]:.3f}" for r in rates for k in keys)))
    note = "Frames that come while a tracker is busy get its last output."
    return Table("Real time", ("tracker", *head), tuple(rows), note)


def restarts(results: Results) -> Table:
    """Accuracy and robustness, one row a tracker."""
    rows = []
    for name in ranked(results):
        t = results["trackers"][name]
        keys = ("failures", "failures_per_100", "reliability")
        rows.append(_row(name, _number(t["accuracy"], ".3f"), *(f"{t[k]:.3f}" for k in keys)))
    head = ("tracker", "accuracy", "failures a run", "failures in 100 frames", "reliability")
    note = "Reliability: the chance to survive 100 frames."
    return Table("Restarts after failure", head, tuple(rows), note)


def published(comparison: dict[str, Any]) -> list[Table]:
    """Published figures beside ours, and the published figures of whole sets."""
    sequences = comparison["sequences"]
    rows = []
    for name, row in comparison["trackers"].items():
        cells = [_number(row["overlap"].get(s), ".3f") for s in sequences]
        rows.append(_row(name, f"{row['mean']:.3f}", *cells, ours=row["ours"]))
    found = [
        Table(
            "Published figures beside ours",
            ("tracker", "mean", *sequences),
            tuple(rows),
            f"Mean overlap, first frame counted as the truth. Source: {comparison['source']}.",
        )
    ]
    for name, trackers in comparison["sets"].items():
        ordered = sorted(trackers.items(), key=lambda item: -item[1]["auc"])
        lines = tuple(_row(n, f"{t['auc']:.3f}", f"{t['p20']:.3f}") for n, t in ordered)
        note = "All its sequences, so not to be compared with the means above."
        found.append(Table(f"Published: {name}", ("tracker", "AUC", "P20"), lines, note))
    return found
