# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
from het_ros.ros.hints import Ration


class Log:
    """The lines that a ration lets through, at times set by hand."""

    def __init__(self, most: int, seconds: float) -> None:
        self.now = 0.0
        self.lines: list[str] = []
        self._ration = Ration(most, seconds, clock=lambda: self.now)

    def say(self, text: str) -> None:
        if line := self._ration.line(text):
            self.lines.append(line)


def test_a_flood_is_logged_in_part_and_counted():
    log = Log(most=3, seconds=10.0)
    for i in range(1000):
        log.now = i * 0.001
        log.say(f"line {i}")
    assert log.lines == ["line 0", "line 1", "line 2"]
    log.now = 10.5
    log.say("later")
    assert log.lines[3] == "later (997 more like it were not logged)"
    log.say("again")
    log.say("and again")
    log.say("too much")
    assert log.lines[4:] == ["again", "and again"]


def test_what_comes_seldom_is_all_logged():
    log = Log(most=2, seconds=1.0)
    for i in range(10):
        log.now = 0.6 * i
        log.say(str(i))
    assert log.lines == [str(i) for i in range(10)]
