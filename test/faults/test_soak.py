# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The soak's verdict on made rows, and a short soak of the installed tracker."""

from __future__ import annotations

import json

import pytest

from het_ros.faults.soak import main
from het_ros.faults.verdict import judge


def rows(**changes) -> list[dict]:
    """An hour of a healthy node in 100 rows; ``changes`` give a value by the row's number."""
    healthy = {
        "rss_mb": 200.0,
        "own_mb": 130.0,
        "files": 18,
        "threads": 14,
        "load": 1.0,
        "sent": 1080,
        "answered": 1079,
        "boxes": 3,
        "visible": 900,
        "right": 850,
        "TRACKING": 1000,
        "COASTING": 70,
        "LOST": 9,
        "silence": 0.05,
        "p50_ms": 9.0,
        "p99_ms": 20.0,
        "probe_p99_ms": 5.0,
        "cpu_ms_a_frame": 9.0,
    }
    made = []
    for i in range(100):
        row = {"time": 36.0 * (i + 1), **healthy}
        made.append(row | {name: change(i) for name, change in changes.items()})
    return made


def missed(**changes) -> list[str]:
    return [check["what"] for check in judge(rows(**changes))["checks"] if not check["met"]]


def test_a_healthy_node_passes():
    assert missed() == [] and judge(rows())["passed"]


@pytest.mark.parametrize(
    "changes, what",
    [
        ({"rss_mb": lambda i: 200 + 0.1 * i}, "memory"),
        ({"own_mb": lambda i: 130 + 0.05 * i}, "memory"),
        ({"p99_ms": lambda i: 20 + 0.1 * i}, "latency"),
        ({"files": lambda i: 18 + i // 30}, "file"),
        ({"threads": lambda i: 14 + (i > 50)}, "threads"),
        ({"silence": lambda i: 3.0 if i == 70 else 0.05}, "silent"),
        ({"COASTING": lambda i: 0}, "hidden"),
    ],
)
def test_what_is_wrong_is_told(changes, what):
    (said,) = missed(**changes)
    assert what in said


@pytest.mark.parametrize(
    "changes",
    [
        {"rss_mb": lambda i: 150 + 50 * (i < 8)},  # while it warms up
        {"rss_mb": lambda i: 200 - 0.4 * i},  # the kernel took back pages of code
        {"p99_ms": lambda i: 200.0 if i == 60 else 20.0},  # once
        # the whole machine was slower in the second half
        {"p99_ms": lambda i: 20 + 20 * (i > 50), "probe_p99_ms": lambda i: 5 + 5 * (i > 50)},
    ],
)
def test_what_is_no_fault_of_the_node_is_not_told(changes):
    assert missed(**changes) == []


def test_too_little_to_judge():
    with pytest.raises(ValueError, match="too few"):
        judge(rows()[:4])


def test_wrong_arguments(capsys, tmp_path):
    assert main(["--minutes", "0", "--out", str(tmp_path)]) == 2
    assert "--minutes" in capsys.readouterr().err


@pytest.mark.slow
def test_a_short_soak(installed, own_environment, tmp_path, capsys):
    """It runs, tracks and reports; half a minute is too short for a verdict on memory."""
    code = main(["--minutes", "0.5", "--loop", "8", "--out", str(tmp_path)])
    assert code in (0, 1)
    soak = json.loads((tmp_path / "soak.json").read_text())
    assert soak["figures"]["answered_share"] > 0 and soak["figures"]["tracking"] > 0
    assert (code == 0) == soak["passed"] == all(check["met"] for check in soak["checks"])
    assert len((tmp_path / "rows.jsonl").read_text().splitlines()) == len(soak["rows"])
    assert (tmp_path / "soak.png").stat().st_size > 10_000
    assert ("PASSED" if soak["passed"] else "FAILED") in capsys.readouterr().out
