"""The figures as text for people."""

from __future__ import annotations

from pathlib import Path
from typing import Any

Results = dict[str, Any]


def ranked(results: Results) -> list[str]:
    """The trackers' names, best AUC first."""
    trackers = results["trackers"]
    return sorted(trackers, key=lambda name: -trackers[name]["auc"])


def table(results: Results) -> str:
    """One row a tracker, best AUC first, in Markdown."""
    lines = [
        "| tracker | AUC | P20 | norm. precision | mean overlap | frames/s | p99 ms | seeds |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name in ranked(results):
        t = results["trackers"][name]
        fps, p99 = (f"{t[k]:.1f}" if t[k] else "-" for k in ("fps", "p99_ms"))
        auc, p20 = (_with_deviation(t, key) for key in ("auc", "p20"))
        lines.append(
            f"| {name} | {auc} | {p20} | {t['norm_precision']:.3f} | {t['mean_overlap']:.3f} "
            f"| {fps} | {p99} | {t['seeds']} |"
        )
    return "\n".join(lines)


def _with_deviation(figures: dict[str, Any], key: str) -> str:
    text = f"{figures[key]:.3f}"
    return f"{text} ± {figures[key + '_std']:.3f}" if figures.get("seeds", 1) > 1 else text


def sequence_table(results: Results, figure: str = "auc") -> str:
    """One row a sequence, one column a tracker, the best in bold, in Markdown."""
    names = ranked(results)
    lines = [f"| sequence | {' | '.join(names)} |", "|---" * (len(names) + 1) + "|"]
    for sequence in results["sequences"]:
        values = [results["trackers"][n]["sequences"][sequence][figure] for n in names]
        cells = [f"**{v:.3f}**" if v == max(values) else f"{v:.3f}" for v in values]
        lines.append(f"| {sequence} | {' | '.join(cells)} |")
    return "\n".join(lines)


def write(results: Results, out: Path) -> None:
    """Write ``out/report.md``."""
    machine = ", ".join(results["machine"].values())
    text = (
        f"# {results['protocol'].upper()}: {len(results['sequences'])} sequences, "
        f"{results['seeds']} seeds\n\n{machine}\n\n{table(results)}\n\n"
        f"## AUC by sequence\n\n{sequence_table(results)}\n\n"
        f"## Precision at 20 px by sequence\n\n{sequence_table(results, 'p20')}\n"
    )
    (out / "report.md").write_text(text)
