# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""docs/NODE.md names every topic of the node, and tests that there are."""

import re
from pathlib import Path

from het_ros.ros.outputs import OUTPUTS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "NODE.md").read_text()


def test_every_named_test_is_there():
    named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", PAGE)
    assert len(named) > 50
    for file, test in named:
        (path,) = (ROOT / "test").rglob(file)
        assert f"def {test}(" in path.read_text(), f"{file}::{test}"


def test_every_output_has_its_row():
    rows = set(re.findall(r"^\| out \| `~?/(\w+)`", PAGE, re.MULTILINE))
    assert rows == {*OUTPUTS, "detections", "diagnostics"}
