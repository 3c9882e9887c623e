# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The map of the house in CONTRIBUTING.md: which packages import which, from the code itself.

example: python test/pages/import_map.py
"""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "CONTRIBUTING.md"
PLACE = re.compile(r"(<!-- map -->\n).*?(<!-- /map -->)", re.DOTALL)
INSIDE = "tracking"  # drawn with its own packages


def part_of(module: str) -> str:
    """The part of the map that a module belongs to; "" for none."""
    words = module.split(".")
    if words[0] != "het_ros" or len(words) < 2 or not (ROOT / "het_ros" / words[1]).is_dir():
        return ""
    if words[1] == INSIDE and len(words) > 2 and (ROOT / "het_ros" / INSIDE / words[2]).is_dir():
        return f"{INSIDE}/{words[2]}"
    return words[1]


def imports() -> set[tuple[str, str]]:
    """(importing part, imported part)."""
    found = set()
    for file in sorted((ROOT / "het_ros").rglob("*.py")):
        module = ".".join(file.relative_to(ROOT).with_suffix("").parts)
        for node in ast.walk(ast.parse(file.read_text())):
            names = [node.module] if isinstance(node, ast.ImportFrom) and node.module else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            found |= {(part_of(module), part_of(name)) for name in names}
    return {(a, b) for a, b in found if a and b and a != b}


def reduced(edges: set[tuple[str, str]]) -> set[tuple[str, str]]:
    """Without edges that a longer way says as well, so that the picture can be read."""
    below = {a: {b for x, b in edges if x == a} for a, _ in edges}

    def reachable(start: str, seen: set[str]) -> set[str]:
        for part in below.get(start, set()) - seen:
            seen.add(part)
            reachable(part, seen)
        return seen

    return {
        (a, b)
        for a, b in edges
        if not any(
            b in reachable(c, set()) and a not in reachable(c, set()) for c in below[a] - {b}
        )
    }


def drawing() -> str:
    """The map in Mermaid's language, which GitHub draws."""
    edges = sorted(
        reduced({(a, b.split("/")[0]) if "/" not in a else (a, b) for a, b in imports()})
    )
    parts = sorted({part for edge in edges for part in edge})
    lines = ["```mermaid", "flowchart BT"]
    lines += [f'    {part.replace("/", "_")}["{part}"]' for part in parts if part != INSIDE]
    lines.append(f'    {INSIDE}["{INSIDE}: tracker, target, box, config"]')
    lines += [f"    {a.replace('/', '_')} --> {b.replace('/', '_')}" for a, b in edges if a != b]
    return "\n".join([*lines, "```"]) + "\n"


def page() -> str:
    """CONTRIBUTING.md with the present map."""
    return PLACE.sub(lambda place: place[1] + drawing() + place[2], PAGE.read_text())


if __name__ == "__main__":
    PAGE.write_text(page())
    print(PAGE)
