# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a busy machine costs: accuracy in real time, alone and beside processes that load it.

The tracker follows the sequences as a camera of 30 or 60 frames/s shows them, first as the machine
is, then with one process a processor that does nothing but compute. A frame that comes while the
tracker is busy is not looked at. Prints a Markdown table, with every failure's forewarning.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from het_ros.bench.figures import plain
from het_ros.evaluation.cache import Cache
from het_ros.evaluation.forewarning import forewarning
from het_ros.evaluation.readers import add_sequences, read_sequences
from het_ros.evaluation.runs import Plan, Run, carry_out_plan
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.summary import score_runs
from het_ros.evaluation.trackers import tracker_spec
from het_ros.tools.arguments import command

BURN = "x = 1.0\nwhile True: x = x * 1.0000001 % 7.0"

EXAMPLE = """example:
  ros2 run het_ros stress --data ../shared/sequences --sequences Crossing,Woman
"""


@contextmanager
def burners(count: int) -> Iterator[None]:
    """So many processes that compute all the time."""
    running = [subprocess.Popen([sys.executable, "-c", BURN]) for _ in range(count)]
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.wait()


def measure(sequences: list[Sequence], cameras: tuple[float, ...], load: int) -> list[dict]:
    """One row a condition: every frame, then each camera on the machine as it is, then loaded."""
    rows = [_row("every frame", sequences, None, 0)]
    for burning in (0, load):
        for camera in cameras:
            name = f"{camera:g} frames/s" + (f", {burning} busy processes" if burning else "")
            rows.append(_row(name, sequences, camera, burning))
    return rows


def _row(name: str, sequences: list[Sequence], camera: float | None, load: int) -> dict[str, Any]:
    plan = Plan(
        trackers=[tracker_spec("het")],
        sequences=sequences,
        protocol="ope" if camera is None else "realtime",
        cameras=(camera or 30.0,),
    )
    before = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder, burners(load) if load else nullcontext():
        runs = carry_out_plan(plan, Cache(Path(folder)), workers=1)
    auc = [scored.score.auc for scored in score_runs(runs, sequences)]
    seen = np.concatenate([np.isfinite(run.track.seconds[1:]) for run in runs])
    seconds = np.concatenate([run.track.seconds[1:] for run in runs])
    return {
        "name": name,
        "auc": float(np.mean(auc)),
        "looked_at": float(seen.mean()),
        "frame_ms": float(1e3 * np.nanmedian(seconds)),
        "frame_p95_ms": float(1e3 * np.nanpercentile(seconds, 95)),
        "load_before": before,
        **forewarning(_with_truth(runs, sequences)),
    }


def _with_truth(runs: list[Run], sequences: list[Sequence]) -> list[tuple[Run, Any]]:
    truths = {sequence.name: sequence.truth for sequence in sequences}
    return [(run, truths[run.sequence][run.rows]) for run in runs]


def table(rows: list[dict[str, Any]]) -> str:
    """The rows as Markdown."""
    lines = [
        "| frames | AUC | looked at | ms a frame (p95) | failures | told in time | late | never "
        "| median lead |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for r in rows:
        lead = "" if r["lead_frames"] is None else f"{r['lead_frames']:+.0f}"
        lines.append(
            f"| {r['name']} | {r['auc']:.3f} | {r['looked_at']:.1%} | {r['frame_ms']:.1f} "
            f"({r['frame_p95_ms']:.1f}) | {r['failures']} | {r['told_in_time']} "
            f"| {r['told_late']} | {r['never_told']} | {lead} |"
        )
    return "\n".join(lines)


def main(argv: list[str] | None = None) -> int:
    """Command line."""
    p = command("stress", __doc__, EXAMPLE)
    add_sequences(p)
    p.add_argument("--cameras", default="30,60", help="frames/s (30,60)")
    p.add_argument(
        "--load", type=int, default=os.cpu_count() or 1, help="processes (one a processor)"
    )
    p.add_argument("--out", type=Path, help="JSON file for the figures")
    options = p.parse_args(argv)
    try:
        names = tuple(name for name in options.sequences.split(",") if name)
        sequences = list(read_sequences(options.data, names, {}))
        cameras = tuple(float(rate) for rate in options.cameras.split(","))
    except (OSError, ValueError) as error:
        print(f"stress: {error}", file=sys.stderr)
        return 2
    rows = measure(sequences, cameras, options.load)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(json.dumps(plain(rows), indent=1))
    print(table(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
