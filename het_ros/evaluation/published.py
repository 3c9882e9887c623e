# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Published figures beside ours, for the sequences that both have."""

from __future__ import annotations

import json
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np

from het_ros.evaluation.tables import Results, ranked


def compare(file: Path, results: Results, excluded: Collection[str] = ()) -> dict[str, Any]:
    """Mean overlaps of published trackers and of ours.

    Args:
        file: JSON with ``per_sequence_overlap`` {SEQUENCE: {TRACKER: mean overlap}}, and maybe
            ``source`` and ``sets`` {SET: {TRACKER: {"auc", "p20"}}}.
        results: the content of ``results.json``.
        excluded: sequences that are not the published ones, though they have their name.

    Returns:
        ``source``; ``sequences`` in common; ``trackers`` {NAME: {"ours", "mean", "overlap":
        {SEQUENCE: ...}}}, best mean first; ``sets`` as published.

    Raises:
        ValueError: the file holds no such figures.
    """
    content = read(file)
    table = content["per_sequence_overlap"]
    common = [s for s in results["sequences"] if s in table and s not in excluded]
    rows: dict[str, dict[str, Any]] = {}
    for name in sorted({n for s in common for n in table[s]}):
        overlap = {s: table[s][name] for s in common if name in table[s]}
        rows[name] = {"ours": False, "overlap": overlap}
    for name in ranked(results):
        own = results["trackers"][name]["sequences"]
        overlap = {s: own[s]["mean_overlap"] for s in common}
        rows[f"{name} (ours)"] = {"ours": True, "overlap": overlap}
    for row in rows.values():
        row["mean"] = float(np.mean(list(row["overlap"].values()))) if row["overlap"] else 0.0
    best_first = dict(sorted(rows.items(), key=lambda item: -item[1]["mean"]))
    return {
        "source": content.get("source", file.name),
        "sequences": common,
        "trackers": best_first,
        "sets": content.get("sets", {}),
    }


def read(file: Path) -> dict[str, Any]:
    """Read a file of published figures.

    Raises:
        ValueError: the file holds none.
    """
    try:
        content: dict[str, Any] = json.loads(file.read_text())
        if isinstance(content["per_sequence_overlap"], dict):
            return content
        reason = "per_sequence_overlap is no mapping"
    except (OSError, KeyError, TypeError, json.JSONDecodeError) as error:
        reason = f"{type(error).__name__}: {error}"
    raise ValueError(
        f"{file} holds no published figures ({reason}): JSON with per_sequence_overlap "
        "{SEQUENCE: {TRACKER: mean overlap}} is needed"
    )
