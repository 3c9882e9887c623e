# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The runner behind `make fuzz`: it counts, it goes on after a failure, it keeps what failed."""

import pytest
from fuzz.campaign import Machine, main, report, run_turn


@pytest.mark.parametrize("body, failed", [("assert True", 0), ("assert x < 100", 1)])
def test_a_turn(tmp_path, body, failed):
    test = tmp_path / "test_it.py"
    test.write_text(
        "from hypothesis import given, strategies\n"
        "@given(strategies.integers())\n"
        f"def test_it(x):\n    {body}\n"
    )
    machine = Machine(f"{test}::test_it")
    run_turn(machine, 10, tmp_path)
    assert machine.turns == 1
    assert len(machine.kept) == failed
    if failed:
        assert "x=100" in machine.kept[0].read_text()
    assert report([machine]).endswith(f"| {failed} |")


def test_a_test_that_dies_is_a_failure(tmp_path):
    (tmp_path / "test_it.py").write_text("import os\ndef test_it():\n    os.abort()\n")
    machine = Machine(f"{tmp_path / 'test_it.py'}::test_it")
    run_turn(machine, 1, tmp_path)
    assert machine.kept[0].read_text().startswith("exit code -6")


def test_cases_of_a_turn_follow_from_those_before():
    assert Machine("new").next_cases(10.0) > 0
    assert Machine("slow", cases=5, seconds=20.0).next_cases(10.0) == 2
    assert Machine("slower", cases=1, seconds=100.0).next_cases(10.0) == 1


@pytest.mark.parametrize("minutes", ["0", "-1", "nan"])
def test_minutes_that_are_none(minutes, capsys):
    with pytest.raises(SystemExit):
        main(["--minutes", minutes])
    assert "give a number over 0" in capsys.readouterr().err
