# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``evaluate --compare A B``: judge a change by what two results folders say."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from het_ros.evaluation import comparison
from het_ros.evaluation.comparison import Comparison
from het_ros.evaluation.comparison_pictures import pictures


def compare(a: str, b: str, out: Path | None, data: Path | None) -> int:
    """Print the differences of two sides and write them to a folder.

    Args:
        a, b: ``FOLDER`` or ``FOLDER:TRACKER``; b is the changed one.
        out: gets ``compare.md``, ``compare.json`` and pictures; by default ``b``'s folder.
        data: the sequences, for the pictures; by default where ``b`` was measured.

    Raises:
        ValueError: a side holds no results, or the two cannot be compared.
    """
    found = comparison.compare(comparison.side(a), comparison.side(b))
    out = out or found.b.folder / "compare"
    out.mkdir(parents=True, exist_ok=True)
    (out / "compare.json").write_text(json.dumps(found.as_json(), indent=1) + "\n")
    text = _page(found)
    print(text)
    drawn = _pictures(found, data, out)
    if drawn:
        text += "\n## Where B loses most\n\nTruth white, A blue, B red.\n\n" + "".join(
            f"{file.stem} ({found.differences['auc'][file.stem]:+.3f})\n\n"
            f"![{file.stem}]({file.relative_to(out)})\n\n"
            for file in drawn
        )
    (out / "compare.md").write_text(text)
    print(out / "compare.md")
    return 0


def _page(found: Comparison) -> str:
    parts = [f"A: {found.a.text}\n\nB: {found.b.text}"]
    if found.left_out:
        parts.append(f"Left out, for only one side has them: {', '.join(found.left_out)}.")
    for table in comparison.tables(found):
        parts += [f"## {table.title}", table.markdown(), table.note]
    return "\n\n".join(parts) + "\n"


def _pictures(found: Comparison, data: Path | None, out: Path) -> list[Path]:
    """The pictures, or none and a line that says why."""
    measured_on = found.b.results.get("data")
    data = data or (Path(measured_on) if measured_on else None)
    if data is None:
        why = "name the sequences with --data"
    elif found.a.results["protocol"] != "ope":
        why = "only runs of the protocol ope are drawn"
    else:
        try:
            return list(pictures(found, data, out / "worst"))
        except (ValueError, OSError) as error:
            why = str(error)
    print(f"evaluate: no pictures: {why}", file=sys.stderr)
    return []
