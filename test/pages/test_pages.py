# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pages are short, their links lead somewhere, and their Python runs."""

import re
import sys

import numpy as np
import pytest

from pages.pages import BLOCK, DOCS, GENERATED, PAGES, ROOT, anchors, blocks, name_of

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
PLACE = re.compile(r"<!-- (\w+)(?:: [^>]*?)? -->.*?<!-- /\1 -->", re.DOTALL)
PYTHON = [
    pytest.param(page, block, id=f"{name_of(page)}-{number}")
    for page in PAGES
    for number, block in enumerate(blocks(page, "python"))
]


def test_the_readme_has_at_most_130_lines():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 130


@pytest.mark.parametrize("page", DOCS, ids=name_of)
def test_a_page_has_at_most_1500_words(page):
    """But for what the program writes."""
    if page.name not in GENERATED:
        assert len(PLACE.sub("", page.read_text()).split()) <= 1500


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_links_lead_somewhere(page):
    text = BLOCK.sub("", page.read_text())
    for link in LINK.findall(text):
        if link.startswith(("http://", "https://", "mailto:")):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), f"{link}: no such file"
        if anchor:
            assert anchor in anchors(target.read_text()), f"{link}: no such heading"


def test_every_page_is_in_the_site():
    navigation = (ROOT / "mkdocs.yml").read_text()
    for page in DOCS:
        assert f" {page.relative_to(ROOT / 'docs')}\n" in navigation, page


@pytest.mark.parametrize("page, block", PYTHON)
def test_python_in_pages_runs(page, block, monkeypatch):
    """With an ``image`` where the page says that there is one."""
    if "geometry_msgs" in block:
        pytest.importorskip("geometry_msgs")
    monkeypatch.setattr(sys, "path", [str(ROOT), *sys.path])
    image = np.random.default_rng(0).integers(0, 255, (240, 320, 3), np.uint8)
    exec(compile(block, name_of(page), "exec"), {"image": image, "__name__": "page"})
