# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The pages on the node name all of its topics, and tests that there are."""

import re
from pathlib import Path

import pytest

from het_ros.ros.outputs import OUTPUTS

ROOT = Path(__file__).parents[2]
REFERENCE = ROOT / "docs" / "reference"
PAGE = (REFERENCE / "node-tests.md").read_text()


def test_every_named_test_is_there():
    named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", PAGE)
    assert len(named) > 50
    for file, test in named:
        paths = (ROOT / "test").rglob(file)
        assert any(f"def {test}(" in path.read_text() for path in paths), f"{file}::{test}"


def test_every_output_has_its_row():
    rows = set(re.findall(r"^\| out \| `~?/(\w+)`", PAGE, re.MULTILINE))
    assert rows == {*OUTPUTS, "detections", "diagnostics"}


@pytest.mark.parametrize("page", [ROOT / "README.md", REFERENCE / "node.md"], ids=str)
def test_the_pages_for_users_name_every_output(page):
    text = page.read_text()
    assert not {name for name in {*OUTPUTS, "detections"} if f"`~/{name}`" not in text}
