# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""docs/reference/fault-tests.md names tests that there are, and every fault's test is named."""

import re
from pathlib import Path

HERE = Path(__file__).parent
PAGE = (HERE.parents[1] / "docs" / "reference" / "fault-tests.md").read_text()
FAULTS = ("restarts", "bad_streams", "two_hosts", "full_disk", "overload", "flood")
ASIDE = {  # about the tests' own tools
    "test_the_process_that_has_ended_is_told",
    "test_the_end_needs_little",
}


def test_every_named_test_is_there():
    named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", PAGE)
    assert len(named) > 20
    for file, test in named:
        assert f"def {test}(" in (HERE / file).read_text(), f"{file}::{test}"


def test_every_fault_is_in_the_table():
    for name in FAULTS:
        for test in re.findall(r"^def (test_\w+)", (HERE / f"test_{name}.py").read_text(), re.M):
            assert f"`test_{name}.py::{test}`" in PAGE or test in ASIDE, test
