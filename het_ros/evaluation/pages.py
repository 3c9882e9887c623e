# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Keep the tables in documents as they came out of the last run."""

from __future__ import annotations

import re
from pathlib import Path

from het_ros.evaluation.report import origin, title
from het_ros.evaluation.tables import Results, Table

# <!-- evaluate: Trackers, AUC by sequence --> ... <!-- /evaluate -->
_PLACE = re.compile(r"(<!-- evaluate: ([^>]*?) -->\n).*?(<!-- /evaluate -->)", re.DOTALL)


def update(page: Path, results: Results, tables: list[Table]) -> None:
    """Rewrite every marked place of a Markdown page with the tables whose titles it names.

    Raises:
        ValueError: the page has no such place, or names a table that this run does not give.
    """
    titled = {table.title: table for table in tables}

    def written(place: re.Match[str]) -> str:
        parts = [f"{title(results)}. {origin(results)}."]
        names = [name.strip() for name in place[2].split(",")]
        for name in names:
            if name not in titled:
                raise ValueError(f"{page} wants a table {name!r}; there are {', '.join(titled)}")
            parts += [f"### {name}"] if len(names) > 1 else []
            parts.append(titled[name].markdown())
            parts += [titled[name].note] if titled[name].note else []
        return place[1] + "\n\n".join(parts) + "\n\n" + place[3]

    text, places = _PLACE.subn(written, page.read_text())
    if not places:
        raise ValueError(
            f"{page} has no place for tables: write <!-- evaluate: Trackers --> and "
            "<!-- /evaluate --> on lines of their own"
        )
    page.write_text(text)
