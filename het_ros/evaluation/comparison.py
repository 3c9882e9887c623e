# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Two results on the same sequences: the paired differences by which a change is judged."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from het_ros.evaluation import groups
from het_ros.evaluation.groups import Mean
from het_ros.evaluation.tables import Row, Table
from het_ros.evaluation.trackers import folder_name

FIGURES = {"auc": "AUC", "p20": "P20", "norm_precision": "norm. precision"}
OTHER = {
    "share of frames confident and off": ("honesty", "off"),
    "recall of visible": ("honesty", "recall"),
    "longest false LOST, frames": ("honesty", "longest_false_lost"),
    "AUC without LOST": ("honesty", "published_auc"),
    "error of velocity, sides/s": ("velocity", "published"),
    "its change from frame to frame, sides/s": ("velocity", "change"),
    "its lag, frames": ("velocity", "lag"),
    "error 0.2 s ahead, sides": ("velocity", "ahead", "0.2", "velocity"),
}
PRINTED = 5e-5  # a difference below is printed as zero
MOVED = 10  # sequences that are listed each way


@dataclass(frozen=True)
class Side:
    """One tracker of one results folder.

    Attributes:
        folder: where ``results.json`` and ``boxes`` lie.
        tracker: the tracker's name in it.
        results: the content of ``results.json``.
    """

    folder: Path
    tracker: str
    results: Mapping[str, Any]

    @property
    def sequences(self) -> Mapping[str, Mapping[str, float]]:
        """The figures by sequence, each a mean over seeds (and starts)."""
        found: Mapping[str, Mapping[str, float]] = self.figures["sequences"]
        return found

    @property
    def figures(self) -> Mapping[str, Any]:
        """All figures of the tracker."""
        figures: Mapping[str, Any] = self.results["trackers"][self.tracker]
        return figures

    def more(self, kind: str, keys: Iterable[str]) -> dict[str, float]:
        """A figure of honesty or velocity by sequence, where the tracker gives it."""
        found = self.figures.get(kind, {})
        by_sequence = found.get("sequences", {}) if kind == "honesty" else found
        values = {}
        for sequence, value in by_sequence.items():
            for key in keys:
                value = value[key]
            if value is not None:
                values[sequence] = float(value)
        return values

    @property
    def tracker_folder(self) -> str:
        """The tracker's name as its folder below ``boxes``."""
        return folder_name(self.tracker)

    @property
    def text(self) -> str:
        """The side in words."""
        seeds = self.figures["seeds"]
        return (
            f"{self.folder}, {self.tracker}, {seeds} seed{'s' * (seeds > 1)}, "
            f"{self.results['date']}"
        )


def side(text: str) -> Side:
    """Read ``FOLDER`` or ``FOLDER:TRACKER``; without a tracker it is the first of the folder.

    Raises:
        ValueError: there is no such folder, no results in it, or no such tracker.
    """
    folder, tracker = Path(text), ""
    if not folder.is_dir():
        name, _, tracker = text.partition(":")
        folder = Path(name)
    file = folder / "results.json"
    try:
        results: dict[str, Any] = json.loads(file.read_text())
        present = list(results["trackers"])
    except (OSError, KeyError, json.JSONDecodeError) as error:
        raise ValueError(
            f"{folder} holds no results ({type(error).__name__}): --compare takes folders that "
            "evaluate wrote, or FOLDER:TRACKER"
        ) from None
    if tracker and tracker not in present:
        raise ValueError(f"{file} has no tracker {tracker!r}; it has {', '.join(present)}")
    return Side(folder, tracker or present[0], results)


@dataclass(frozen=True)
class Comparison:
    """Side ``b`` minus side ``a``.

    Attributes:
        a, b: the sides.
        sequences: those that both have, in ``a``'s order.
        left_out: those that only one has.
        differences: by figure and sequence.
    """

    a: Side
    b: Side
    sequences: tuple[str, ...]
    left_out: tuple[str, ...]
    differences: Mapping[str, Mapping[str, float]]

    def worst_first(self, figure: str = "auc") -> list[str]:
        """The sequences, those first on which ``b`` loses most."""
        return sorted(self.sequences, key=self.differences[figure].__getitem__)

    def as_json(self) -> dict[str, Any]:
        """Everything that the tables say, as plain numbers."""
        by_group = {f: groups.means(d) for f, d in self.differences.items()}
        return {
            "a": {"folder": str(self.a.folder), "tracker": self.a.tracker},
            "b": {"folder": str(self.b.folder), "tracker": self.b.tracker},
            "left_out": list(self.left_out),
            "differences": {f: dict(values) for f, values in self.differences.items()},
            "groups": {
                figure: {
                    group: {"mean": m.value, "standard_error": m.error, "sequences": m.count}
                    for group, m in found.items()
                }
                for figure, found in by_group.items()
            },
        }


def compare(a: Side, b: Side) -> Comparison:
    """Pair two sides by sequence.

    Raises:
        ValueError: they share no sequence, or were run by different protocols.
    """
    if a.results["protocol"] != b.results["protocol"]:
        raise ValueError(
            f"{a.folder} is {a.results['protocol']}, {b.folder} is {b.results['protocol']}: only "
            "runs of one protocol can be compared"
        )
    shared = tuple(name for name in a.sequences if name in b.sequences)
    if not shared:
        raise ValueError(f"{a.folder} and {b.folder} share no sequence")
    left_out = sorted(set(a.sequences) ^ set(b.sequences))
    differences = {
        figure: {s: b.sequences[s][figure] - a.sequences[s][figure] for s in shared}
        for figure in FIGURES
    }
    return Comparison(a, b, shared, tuple(left_out), differences)


def tables(found: Comparison) -> list[Table]:
    """Differences over all and by group, and the sequences that moved most."""
    listed = [_by_group(found), _other(found), _moved(found)]
    return [table for table in listed if table.rows]


def _by_group(found: Comparison) -> Table:
    by_figure = {f: groups.means(found.differences[f]) for f in FIGURES}
    rows = []
    for group, members in groups.grouped(found.sequences).items():
        cells = [group, str(len(members))]
        for figure in FIGURES:
            before, after = (
                groups.mean(s.sequences[name][figure] for name in members).value
                for s in (found.a, found.b)
            )
            apart = by_figure[figure][group]
            cells += [f"{before:.3f}", f"{after:.3f}", f"{apart:+.4f}", in_errors(apart)]
        rows.append(Row.of(*cells))
    head = [h for name in FIGURES.values() for h in (f"{name} A", "B", "B - A", "/ s.e.")]
    return Table(
        "Difference",
        ("sequences", "n", *head),
        tuple(rows),
        "B - A: mean over sequences of the paired difference, seeds averaged first, ± its "
        "standard error over sequences; / s.e.: the same in standard errors. What has two or more "
        "over all is a gain.",
    )


def _other(found: Comparison) -> Table:
    """Honesty, velocity and prediction, where both sides have them."""
    rows = []
    for label, (kind, *keys) in OTHER.items():
        sides = [side.more(kind, keys) for side in (found.a, found.b)]
        shared = [s for s in found.sequences if all(s in side for side in sides)]
        if not shared:
            continue
        apart = groups.mean(sides[1][s] - sides[0][s] for s in shared)
        before, after = (groups.mean(side[s] for s in shared).value for side in sides)
        figures = [f"{before:.3f}", f"{after:.3f}", f"{apart:+.4f}", in_errors(apart)]
        rows.append(Row.of(label, str(len(shared)), *figures))
    return Table(
        "Honesty and velocity",
        ("figure", "n", "A", "B", "B - A", "/ s.e."),
        tuple(rows),
        "Less is better but of recall and AUC. As defined in the tables of the same names.",
    )


def in_errors(difference: Mean) -> str:
    """A difference in its standard errors; a dash where that has no meaning."""
    error = difference.error
    if not error or max(abs(difference.value), error) < PRINTED:  # nothing but last bits
        return "-"
    return f"{difference.value / error:+.1f}"


def _moved(found: Comparison) -> Table:
    changes = found.differences["auc"]
    order = sorted(found.sequences, key=lambda s: -abs(changes[s]))[:MOVED]
    rows = []
    for name in sorted(order, key=changes.__getitem__):
        a, b = found.a.sequences[name], found.b.sequences[name]
        moved = [f"{found.differences[f][name]:+.3f}" for f in FIGURES]
        stds = f"{a['auc_std']:.3f}, {b['auc_std']:.3f}"
        rows.append(Row.of(name, f"{a['auc']:.3f}", f"{b['auc']:.3f}", *moved, stds))
    return Table(
        "Sequences that moved most",
        ("sequence", "AUC A", "AUC B", *(f"{n} B - A" for n in FIGURES.values()), "AUC of seeds"),
        tuple(rows),
        "Lost most first. AUC of seeds: standard deviation over the seeds on A and on B; a move "
        "within it is chance.",
    )
