# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a process holds, second by second: memory, files, threads, processor time."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path

from het_ros.bench.process import usage


@dataclass(frozen=True)
class Sample:
    """One look at a process.

    Attributes:
        time: when, s on the monotonic clock.
        cpu: processor time since its start, s.
        rss_mb: memory that it holds, MB.
        own_mb: the part of it that is its own (heap and stacks), MB; the rest is code and what
            it shares with others, such as the images that they send through shared memory.
        files: open file descriptors.
        threads: threads.
        load: the machine's load average of the last minute.
    """

    time: float
    cpu: float
    rss_mb: float
    own_mb: float
    files: int
    threads: int
    load: float


def look(pid: int) -> Sample:
    """What the process ``pid`` holds now.

    Raises:
        OSError: there is no such process (any more), or no /proc (this is not Linux).
    """
    try:
        used = usage(pid)
    except KeyError:  # it has ended, and nobody has asked for its exit code yet
        raise ProcessLookupError(f"process {pid} has ended") from None
    folder = Path("/proc") / str(pid)
    return Sample(
        time=time.monotonic(),
        cpu=used.cpu,
        rss_mb=used.rss_mb,
        own_mb=_anonymous(folder),
        files=sum(1 for _ in (folder / "fd").iterdir()),
        threads=used.threads,
        load=os.getloadavg()[0],
    )


def _anonymous(folder: Path) -> float:
    for line in (folder / "status").read_text().splitlines():
        if line.startswith("RssAnon:"):
            return int(line.split()[1]) * 1024 / 1e6
    return float("nan")
