# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Docstrings, comments, messages and pages use the field's words, not ours of former days."""

import io
import re
import tokenize

import pytest

from pages.pages import PAGES, ROOT, name_of

# What not to write, and what to write.
BANNED = {
    r"trust(s|ed|ing)?": "confidence, probability, score",
    r"scenery|miniatures?": "background, small image",
    r"first[ _-]look|likeness": "alignment to the first frame",
    r"inertia": "ego-motion",
    r"in sight": "visible",
    r"witness(es)?": "measurement gate",
    r"hints?": "log line",
    r"pursuit": "pipeline",
    r"verdict": "confidence, result",
    r"rivals?|twins?": "distractor",
    r"probation": "lower score after a re-detection",
}
WORDS = re.compile(rf"\b({'|'.join(BANNED)})\b", re.IGNORECASE)
CODE = re.compile(r"``?[^`\n]+``?|:\w+:`[^`\n]*`|<!-- bench -->.*?<!-- /bench -->", re.DOTALL)
# Names of the public interface and of arguments, where they are explained.
ALLOWED = {
    "witness": re.compile(r"^\s*\"?witness\"?(, candidates)?:|^\"Witness\"$", re.IGNORECASE),
    "hints": re.compile(r"^\s*hints:"),
    "pursuit": re.compile(r"^\s*pursuit:"),
    "trusted": re.compile(r"^\s*trusted:"),
}
EXEMPT = {"CHANGELOG.md"}  # it names parameters that are gone
MODULES = sorted((ROOT / "het_ros").rglob("*.py"))
TEXTS = {tokenize.STRING, tokenize.COMMENT, getattr(tokenize, "FSTRING_MIDDLE", -1)}


def wrong(text: str) -> list[str]:
    """Lines with a word that is not to be used, and the words."""
    found = []
    for line in CODE.sub("", text).splitlines():
        for match in WORDS.finditer(line):
            allowed = ALLOWED.get(match[0].lower())
            if not (allowed and allowed.search(line)):
                found.append(f"{match[0]!r} in: {line.strip()}")
    return found


def texts(source: str) -> str:
    """Comments and strings of a module, docstrings and messages among them."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    return "\n".join(token.string for token in tokens if token.type in TEXTS)


@pytest.mark.parametrize("module", MODULES, ids=name_of)
def test_a_module(module):
    assert not wrong(texts(module.read_text()))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_a_page(page):
    if page.name not in EXEMPT:
        assert not wrong(page.read_text())


@pytest.mark.parametrize(
    "text, found",
    [
        ('"""How far it can be trusted."""', 1),
        ("# the rival's score", 1),
        ("x = 'a Witness says no'", 1),
        ('"""Takes ``witness`` and depth_witness."""', 0),
        ("trust = 1", 0),
    ],
)
def test_words_are_found_in_texts_only(text, found):
    assert len(wrong(texts(text.strip()))) == found
