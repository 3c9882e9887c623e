# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Boxes that others published, scored as ours are, on the sequences that they have."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from collections.abc import Sequence as Listing
from pathlib import Path
from typing import Any

import numpy as np

from het_ros.evaluation.annotations import read_boxes
from het_ros.evaluation.metrics import score
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.tables import Cell, Results, Row, Table, ranked

FIGURES = ("auc", "p20")


def named(texts: Iterable[str]) -> dict[str, Path]:
    """Folders by name from options like ``NAME=folder``.

    Raises:
        ValueError: an option is none of these, or its folder holds no boxes.
    """
    folders = {}
    for text in texts:
        name, _, folder = text.partition("=")
        if not name or not folder or name in folders:
            raise ValueError(f"--boxes takes NAME=folder, each name once, not {text!r}")
        if not any(Path(folder).glob("*.txt")):
            raise ValueError(
                f"--boxes {text}: no boxes in that folder: SEQUENCE.txt with x,y,w,h a line, the "
                "top-left pixel being 1, 1 (OTB), is looked for"
            )
        folders[name] = Path(folder)
    return folders


def scored(
    folders: Mapping[str, Path], sequences: Listing[Sequence], excluded: Collection[str] = ()
) -> dict[str, Any]:
    """Score ``SEQUENCE.txt`` of every folder against the truth.

    Args:
        folders: by the name of who published the boxes.
        sequences: those of the run.
        excluded: sequences that are not the published ones, though they have their name.

    Returns:
        By name: ``auc`` and ``p20``, means over its ``sequences`` {SEQUENCE: {"auc", "p20"}};
        ``left_out`` {SEQUENCE: why}, for those whose file has another number of boxes.

    Raises:
        ValueError: a line of a file is no box, or a folder has none of the sequences.
    """
    return {name: _scored(folder, sequences, excluded) for name, folder in folders.items()}


def _scored(
    folder: Path, sequences: Listing[Sequence], excluded: Collection[str]
) -> dict[str, Any]:
    found: dict[str, dict[str, float]] = {}
    left_out: dict[str, str] = {}
    for sequence in sequences:
        file = folder / f"{sequence.name}.txt"
        if not file.is_file() or sequence.name in excluded:
            continue
        boxes = read_boxes(file, first_pixel=1)
        if len(boxes) != len(sequence.truth):
            left_out[sequence.name] = f"{len(boxes)} boxes for {len(sequence.truth)} frames"
            continue
        result = score(boxes, sequence.truth)
        found[sequence.name] = {figure: getattr(result, figure) for figure in FIGURES}
    if not found:
        reasons = "; ".join(f"{name}: {why}" for name, why in left_out.items())
        raise ValueError(f"{folder} has boxes for none of the sequences. {reasons}".strip())
    return {**_means(found, found), "sequences": found, "left_out": left_out}


def _means(figures: Mapping[str, Any], names: Iterable[str]) -> dict[str, float]:
    listed = list(names)
    return {f: float(np.mean([figures[name][f] for name in listed])) for f in FIGURES}


def tables(others: dict[str, Any], results: Results) -> list[Table]:
    """Two tables: the means of each, and ours on the same sequences; AUC by sequence."""
    if not others:
        return []
    ours = {name: results["trackers"][name]["sequences"] for name in ranked(results)}
    rows = []
    for name, figures in others.items():
        same = [_means(of, figures["sequences"]) for of in ours.values()]
        values = [_pair(figures), *map(_pair, same)]
        aucs = [m["auc"] for m in (figures, *same)]
        cells = [Cell(v, a == max(aucs)) for v, a in zip(values, aucs, strict=True)]
        rows.append(Row((Cell(name), Cell(str(len(figures["sequences"]))), *cells)))
    means = Table(
        "Boxes of others beside ours",
        ("boxes of", "sequences", "their AUC / P20", *ours),
        tuple(rows),
        "AUC / P20, means over the sequences that both have, scored alike." + _gaps(others),
    )
    listed = [s for s in results["sequences"] if any(s in o["sequences"] for o in others.values())]
    theirs = {name: figures["sequences"] for name, figures in others.items()}
    lines = [_line(s, [of.get(s) for of in (*theirs.values(), *ours.values())]) for s in listed]
    head = ("sequence", *(f"{name} (their boxes)" for name in theirs), *ours)
    return [means, Table("AUC by sequence, boxes of others", head, tuple(lines))]


def _pair(figures: Mapping[str, float]) -> str:
    return f"{figures['auc']:.3f} / {figures['p20']:.3f}"


def _line(sequence: str, figures: list[Mapping[str, float] | None]) -> Row:
    best = max(f["auc"] for f in figures if f)
    cells = (Cell(f"{f['auc']:.3f}", f["auc"] == best) if f else Cell("-") for f in figures)
    return Row((Cell(sequence), *cells))


def _gaps(others: dict[str, Any]) -> str:
    gaps = [
        f"{name}, {sequence} ({why})"
        for name, figures in others.items()
        for sequence, why in figures["left_out"].items()
    ]
    return f" Left out: {'; '.join(gaps)}." if gaps else ""
