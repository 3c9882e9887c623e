# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from het_ros.evaluation.pages import update
from het_ros.evaluation.tables import Cell, Row, Table

MACHINE = {k: k for k in ("cpu", "system", "python", "numpy", "opencv")}
RESULTS = {"protocol": "ope", "date": "2001-02-03", "seeds": 3, "sequences": ["a"]}
RESULTS["machine"] = MACHINE
TABLES = [
    Table(
        "Trackers", ("tracker", "AUC"), (Row((Cell("het"), Cell("0.600", best=True))),), "Note."
    ),
    Table("Other", ("x",), ()),
]


def test_marked_places_are_rewritten_and_the_rest_stays(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- evaluate: Trackers -->\nold\n<!-- /evaluate -->\nafter\n")
    update(page, RESULTS, TABLES)
    text = page.read_text()
    assert text.startswith("before\n<!-- evaluate: Trackers -->\nOne-pass evaluation: 1 seq")
    assert "2001-02-03; cpu" in text
    assert "| het | **0.600** |" in text
    assert "old" not in text
    assert text.endswith("Note.\n\n<!-- /evaluate -->\nafter\n")
    update(page, RESULTS, TABLES)
    assert page.read_text() == text, "twice is as once"


def test_several_tables_in_one_place_get_headings(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("<!-- evaluate: Trackers, Other -->\n<!-- /evaluate -->\n")
    update(page, RESULTS, TABLES)
    assert "### Trackers\n\n| tracker |" in page.read_text()
    assert "### Other\n\n| x |" in page.read_text()


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("nothing", "has no place for tables"),
        ("<!-- evaluate: None -->\n<!-- /evaluate -->", "wants a table 'None'; there are Tra"),
    ],
)
def test_a_page_that_cannot_be_written_says_why(tmp_path, text, complaint):
    page = tmp_path / "page.md"
    page.write_text(text)
    with pytest.raises(ValueError, match=complaint):
        update(page, RESULTS, TABLES)
    assert page.read_text() == text
