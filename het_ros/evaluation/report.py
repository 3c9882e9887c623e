# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``report.md`` and a self-contained ``report.html``."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2

from het_ros.evaluation.drawing import Colour
from het_ros.evaluation.strips import SHOWN
from het_ros.evaluation.tables import Results, Table, ranked

TEMPLATES = Path(__file__).parent / "templates"


def write_markdown(
    results: Results, tables: list[Table], plots: Mapping[str, bytes], out: Path
) -> Path:
    """Write ``out/report.md``, with its plots as files in ``out/plots``."""
    (out / "plots").mkdir(parents=True, exist_ok=True)
    for name, png in plots.items():
        (out / "plots" / f"{name}.png").write_bytes(png)
    parts = [f"# {title(results)}", origin(results), *results.get("notes", [])]
    pictures = " ".join(f"![{name}](plots/{name}.png)" for name in plots)
    for number, table in enumerate(tables):
        parts += [f"## {table.title}", table.markdown()]
        parts += [table.note] if table.note else []
        parts += [pictures] if number == 0 else []
    parts += [f"## Failures\n\n{_failures_text(results)}"] if _failures(results) else []
    file = out / "report.md"
    file.write_text("\n\n".join(parts) + "\n")
    return file


def write_html(
    results: Results,
    tables: list[Table],
    plots: Mapping[str, bytes],
    strips: Mapping[str, bytes],
    palette: Mapping[str, Colour],
    out: Path,
) -> Path:
    """Write ``out/report.html``; its pictures are inside, so one file is the whole report."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, trim_blocks=True
    )
    names = ranked(results)
    page = environment.get_template("report.html.j2").render(
        title=title(results),
        origin=origin(results),
        notes=results.get("notes", []),
        tables=tables,
        plots={name: _data_uri(png, "png") for name, png in plots.items()},
        strips={name: _data_uri(jpeg, "jpeg") for name, jpeg in strips.items()},
        names=names,
        shown=names[:SHOWN],
        css={name: "rgb({}, {}, {})".format(*palette[name]) for name in names},
        failures=_failures(results),
    )
    file = out / "report.html"
    file.write_text(page)
    return file


def title(results: Results) -> str:
    """What was run."""
    kinds = {
        "ope": "One-pass evaluation",
        "tre": "Temporal robustness (20 starts)",
        "sre": "Spatial robustness (12 disturbed starts)",
        "passes": "Five passes (forwards, backwards, in parts, at half the rate)",
        "half_rate": "Half the frame rate",
        "realtime": "Real time",
        "restart": "Restart after failure",
    }
    count = len(results["sequences"])
    return f"{kinds[results['protocol']]}: {count} sequences, {results['seeds']} seeds"


def origin(results: Results) -> str:
    """When and where it was measured."""
    m = results["machine"]
    return (
        f"{results['date']}; {m['cpu']}; {m['system']}; Python {m['python']}, "
        f"NumPy {m['numpy']}, OpenCV {m['opencv']}"
    )


def _failures(results: Results) -> list[dict[str, Any]]:
    return [
        {"tracker": name, **failure}
        for name, figures in results["trackers"].items()
        for failure in figures["errors"]
    ]


def _failures_text(results: Results) -> str:
    form = "- {tracker}, {sequence}, seed {seed}, {start}: {error}"
    return "\n".join(form.format(**failure) for failure in _failures(results))


def _data_uri(data: bytes, kind: str) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"
