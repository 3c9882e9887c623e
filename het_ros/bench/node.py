# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The node: image to box at several sizes and rates, each case in processes of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

from tqdm import tqdm

from het_ros.bench.figures import percentiles
from het_ros.bench.process import THREADS
from het_ros.tools.tracker_process import own_graph

SIZES = {"vga": (640, 480), "720p": (1280, 720), "1080p": (1920, 1080)}
RATES = (30, 60)
PROMISED = "1080p30"  # the case that is held to: 60 s of it in a full run
FULL_SECONDS = 60.0


class NodeCaseError(RuntimeError):
    """A case's process failed; the text has its last words."""


def node(
    seconds: float, full: bool = False, only: Sequence[str] = (), quiet: bool = False
) -> dict[str, Any]:
    """Every case, by a name such as "1080p30".

    Args:
        seconds: that are counted of each case.
        full: 60 s of the case 1080p30.
        only: names of cases; empty for all.
        quiet: no progress bar.

    Returns:
        By case: what was measured with camera and tracker in two processes (sent, dropped,
        latency, own, cpu_share, memory), ``one_process`` the same in one, ``core`` the
        percentiles of the core alone on the same frames at the same rate, and
        ``added_p95_ms``, the node's own p95 (arrival to publishing) less the core's.

    Raises:
        NodeCaseError: no case could be measured; one that could not is said and left out.
    """
    names = {f"{size}{rate}": (size, rate) for size in SIZES for rate in RATES}
    found: dict[str, Any] = {}
    failed: list[NodeCaseError] = []
    with tqdm([n for n in names if not only or n in only], desc="node", disable=quiet) as bar:
        for name in bar:
            bar.set_postfix_str(name)
            size, rate = names[name]
            length = FULL_SECONDS if full and name == PROMISED else seconds
            case = (f"--size={'x'.join(map(str, SIZES[size]))}", f"--rate={rate}")
            try:
                found[name] = _case(case, seconds, length)
            except NodeCaseError as error:
                failed.append(error)
                tqdm.write(f"bench: {name}: {error}", file=sys.stderr)
    if failed and not found:
        raise failed[0]
    return found


def _case(case: Sequence[str], seconds: float, length: float) -> dict[str, Any]:
    # The core before and after, so that a machine that changes meanwhile is noticed less.
    times = run_case(*case, f"--seconds={seconds / 2}", "--how=core")["times"]
    two = run_case(*case, f"--seconds={length}", "--how=two")
    times += run_case(*case, f"--seconds={seconds / 2}", "--how=core")["times"]
    core = percentiles(times)
    one = run_case(*case, f"--seconds={seconds}", "--how=one")
    added = two["own"]["p95_ms"] - core["p95_ms"]
    return {**two, "one_process": one, "core": core, "added_p95_ms": added}


def run_case(*arguments: str) -> dict[str, Any]:
    """Run ``het_ros.bench.node_case`` in a ROS graph of its own and read what it prints.

    Raises:
        NodeCaseError: it failed.
    """
    environment = os.environ | THREADS | own_graph()
    command = [sys.executable, "-m", "het_ros.bench.node_case", *arguments]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise NodeCaseError(f"{' '.join(arguments)} failed:\n{done.stderr[-2000:]}")
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result
