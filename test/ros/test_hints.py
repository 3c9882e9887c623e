# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from het_ros.ros.hints import Ration


def test_a_flood_is_logged_in_part_and_counted():
    lines, now = [], [0.0]
    ration = Ration(most=3, seconds=10.0, clock=lambda: now[0])

    def say(text: str) -> None:
        if line := ration.line(text):
            lines.append(line)

    for i in range(1000):
        now[0] = i * 0.001
        say(f"line {i}")
    assert lines == ["line 0", "line 1", "line 2"]
    now[0] = 10.5
    say("later")
    assert lines[3] == "later (997 more like it were not logged)"
    say("again")
    say("and again")
    say("too much")
    assert lines[4:] == ["again", "and again"]


def test_what_comes_seldom_is_all_logged():
    lines, now = [], [0.0]
    ration = Ration(most=2, seconds=1.0, clock=lambda: now[0])

    def say(text: str) -> None:
        if line := ration.line(text):
            lines.append(line)

    for i in range(10):
        now[0] = 0.6 * i
        say(str(i))
    assert lines == [str(i) for i in range(10)]
