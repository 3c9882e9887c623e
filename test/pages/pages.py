# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The project's Markdown pages, and the code in them."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "bags" / "README.md", *DOCS]
GENERATED = {"PARAMETERS.md", "RESULTS.md"}  # written by the program; performance.md in part
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


def blocks(page: Path, language: str) -> list[str]:
    """Code blocks of one language; "" is the shell's."""
    return [text for kind, text in BLOCK.findall(page.read_text()) if kind == language]


def commands(page: Path) -> list[str]:
    """Shell commands, one a line, without comments; what ends with a backslash goes on."""
    joined = "".join(blocks(page, "")).replace("\\\n", " ")
    lines = (re.sub(r"\s+#.*|^#.*", "", line) for line in joined.splitlines())
    return [" ".join(line.split()) for line in lines if line.strip()]


def anchors(text: str) -> set[str]:
    """What a link may name of a page: its headings, as GitHub and MkDocs spell them."""
    titles = re.findall(r"^#+ (.*)$", BLOCK.sub("", text), re.MULTILINE)
    plain = (re.sub(r"[^\w\- ]", "", title.lower()) for title in titles)
    return {title.replace(" ", "-") for title in plain}
