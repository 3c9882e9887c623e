# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Run every fuzz test in turns until the time is up, and keep what fails: `make fuzz MINUTES=n`.

Each turn is a pytest process of its own, so that a crash of a library is a failure of that turn
and not the end of the run. A test that failed gets no more turns; the next run with the same
folder tries what failed before anything new.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tqdm import tqdm

HERE = Path(__file__).parent
FIRST_CASES = 30
LEAST_TURN, LONGEST_TURN = 5.0, 30.0  # s that a turn is meant to take
MOST_MEMORY = 6 << 30  # bytes of addresses a turn may use: less than it takes to hurt a machine
MOST_LINE = 300  # characters of a line that are kept: an image is printed as 100 kB

EXAMPLE = """example:
  python test/fuzz/campaign.py --minutes 15 --out out/fuzz
"""


@dataclass
class Machine:
    """One fuzz test and what came of it.

    Attributes:
        name: pytest's name of it.
        cases: inputs that were tried.
        seconds: how long that took.
        turns: in so many processes.
        kept: log of the failure, if there was one.
    """

    name: str
    cases: int = 0
    seconds: float = 0.0
    turns: int = 0
    kept: list[Path] = field(default_factory=list)

    @property
    def weight(self) -> int:
        """Turns for each turn of a test of one function: state machines have more to find."""
        return 3 if self.name.endswith("runTest") else 1

    def next_cases(self, turn: float) -> int:
        """How many cases fill a turn of so many seconds."""
        if not self.cases:
            return FIRST_CASES
        return max(1, round(self.cases / self.seconds * turn))


def machines() -> list[Machine]:
    """All tests below this folder."""
    listed = subprocess.run(
        [sys.executable, "-m", "pytest", "--collect-only", "-q", str(HERE)],
        capture_output=True,
        text=True,
        cwd=HERE.parents[1],
        check=True,
    )
    return [Machine(line) for line in listed.stdout.splitlines() if "::" in line]


def run_turn(machine: Machine, cases: int, out: Path) -> None:
    """Try so many new cases of a machine; the log of a failure is kept."""
    count, log = out / "count.json", out / "turn.log"
    count.unlink(missing_ok=True)
    pytest = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    begin = time.monotonic()
    with log.open("w") as output:
        code = subprocess.call(
            ["prlimit", f"--as={MOST_MEMORY}", *pytest, machine.name],
            cwd=HERE.parents[1],
            stdout=output,
            stderr=subprocess.STDOUT,
            env={
                **os.environ,
                "HET_FUZZ_CASES": str(cases),
                "HET_FUZZ_FOUND": str((out / "found").resolve()),
                "HET_FUZZ_COUNT": str(count.resolve()),
            },
        )
    machine.seconds += time.monotonic() - begin
    machine.turns += 1
    machine.cases += sum(json.loads(count.read_text()).values()) if count.exists() else 0
    if code:
        name = machine.name.partition("::")[2].replace("::", ".")
        machine.kept.append(out / f"{name}.txt")
        lines = [f"exit code {code}", *log.read_text(errors="replace").splitlines()]
        machine.kept[-1].write_text("\n".join(line[:MOST_LINE] for line in lines) + "\n")
    log.unlink()


def run(minutes: float, out: Path) -> list[Machine]:
    """Give every machine its turn, again and again, for so many minutes."""
    out.mkdir(parents=True, exist_ok=True)
    every = machines()
    turn = min(max(60 * minutes / len(every) / 2, LEAST_TURN), LONGEST_TURN)
    begin = time.monotonic()
    with tqdm(total=round(60 * minutes), unit="s", desc="fuzz") as progress:
        while (passed := time.monotonic() - begin) < 60 * minutes:
            sound = [machine for machine in every if not machine.kept]
            if not sound:
                break
            machine = min(sound, key=lambda m: m.turns / m.weight)
            failed = len(every) - len(sound)
            progress.set_postfix_str(f"{sum(m.cases for m in every)} cases, {failed} failed")
            run_turn(machine, machine.next_cases(min(turn, 60 * minutes - passed)), out)
            progress.update(min(round(time.monotonic() - begin), progress.total) - progress.n)
    return every


def report(every: Sequence[Machine]) -> str:
    """Markdown table: test, cases tried, seconds, whether it failed."""
    rows = ["| what | cases | s | failed |", "|---|---|---|---|"]
    rows += [
        f"| {m.name.rpartition('/')[2]} | {m.cases} | {m.seconds:.0f} | {len(m.kept)} |"
        for m in every
    ]
    failed = sum(len(m.kept) for m in every)
    total = (sum(m.cases for m in every), sum(m.seconds for m in every))
    return "\n".join([*rows, f"| all | {total[0]} | {total[1]:.0f} | {failed} |"])


def main(argv: Sequence[str] | None = None) -> int:
    """Command line; 0 if nothing failed, 1 if something did."""
    parser = argparse.ArgumentParser(
        description=__doc__,
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--minutes", type=float, default=10, help="how long (default: 10)")
    parser.add_argument(
        "--out", type=Path, default=Path("out/fuzz"), help="folder for what fails (out/fuzz)"
    )
    options = parser.parse_args(argv)
    if not 0 < options.minutes < 60 * 24 * 30:
        parser.error(f"--minutes {options.minutes:g}: give a number over 0")
    every = run(options.minutes, options.out)
    table = report(every)
    (options.out / "report.md").write_text(table + "\n")
    print(table)
    failed = [machine for machine in every if machine.kept]
    for machine in failed:
        print(f"failed: {machine.name}: {machine.kept[0]}")
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
