# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a process takes of the machine: processor time and memory, as Linux counts them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

THREADS = {  # one thread for everything that would otherwise take every processor
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "OPENCV_FOR_THREADS_NUM": "1",
}
_TICKS = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class Usage:
    """Of one process.

    Attributes:
        cpu: processor time since its start, s, of all its threads.
        rss_mb: memory that it holds now, MB.
        peak_mb: the most that it ever held, MB.
        threads: how many it has.
    """

    cpu: float
    rss_mb: float
    peak_mb: float
    threads: int


def usage(pid: int) -> Usage:
    """What the process ``pid`` takes.

    Raises:
        OSError: there is no such process, or no /proc (this is not Linux).
    """
    folder = Path("/proc") / str(pid)
    # The name, in brackets, may hold spaces; the fields are counted after it.
    fields = (folder / "stat").read_text().rpartition(")")[2].split()
    status = dict(
        line.split(":", 1) for line in (folder / "status").read_text().splitlines() if ":" in line
    )

    def megabytes(name: str) -> float:
        return int(status[name].split()[0]) * 1024 / 1e6

    return Usage(
        cpu=(int(fields[11]) + int(fields[12])) / _TICKS,
        rss_mb=megabytes("VmRSS"),
        peak_mb=megabytes("VmHWM"),
        threads=int(status["Threads"]),
    )
