# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``make bench``: everything in one run, to bench.json, a report and the documentation."""

from __future__ import annotations

import argparse
import datetime
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from het_ros.bench import report
from het_ros.bench.core import OURS, PAPER, core, sequences_for
from het_ros.bench.figures import missing, plain
from het_ros.bench.footage import Footage, middle
from het_ros.bench.imports import weigh_imports
from het_ros.bench.node import NodeCaseError, node, run_case
from het_ros.bench.plots import plots
from het_ros.bench.scaling import TARGET_IN_IMAGES, cases_of, scaling
from het_ros.bench.stages import stage_times
from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.summary import machine
from het_ros.tools.arguments import INTERRUPTED, command
from het_ros.tools.tracker_process import TrackerProcessError
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.paper.config import PaperConfig

PARTS = ("core", "stages", "scaling", "node", "start")
EXAMPLE = """\
examples:
  ros2 run het_ros bench --data ../shared/sequences --out out/bench --full
  ros2 run het_ros bench --out out/try --quick --parts core,stages
  ros2 run het_ros bench --out out/networks --parts core --models ../shared/models
"""


def main(arguments: list[str] | None = None) -> int:
    """Measure and report; 0 when all was measured, 2 when something could not be."""
    options = parser().parse_args(arguments)
    try:
        bench = measured(options)
    except (ValueError, OSError) as error:
        print(f"bench: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return INTERRUPTED
    for row in report.promises.rows(bench):
        print("  ".join(cell.replace("*", "") for cell in row))
    print(f"report: {options.out / 'report.md'}")
    absent = missing(bench) if options.parts == PARTS else []
    if absent:
        print(f"bench: not measured: {', '.join(absent)}", file=sys.stderr)
    return 2 if absent or "failed" in bench else 0


def parser() -> argparse.ArgumentParser:
    """The command line."""
    p = command(
        "bench",
        "Measure what a frame costs: core and peers, scaling, stages, node, start.",
        EXAMPLE,
    )
    p.add_argument("--out", type=Path, required=True, help="folder for bench.json and report.md")
    p.add_argument(
        "--data", type=Path, help="folder of real sequences (OTB, VOT); without: a rendered street"
    )
    p.add_argument("--models", type=Path, help="folder of the networks' files, else left out")
    p.add_argument("--full", action="store_true", help="60 s of 1080p at 30 frames/s")
    p.add_argument("--quick", action="store_true", help="few frames and small images, to try it")
    p.add_argument("--frames", type=_positive, help="timed on each sequence (40; quick: 5)")
    p.add_argument("--seconds", type=_positive, help="of each case of the node (10; quick: 2)")
    p.add_argument("--parts", type=_parts, default=PARTS, help=f"({','.join(PARTS)})")
    p.add_argument("--cases", default="", help="of the node, e.g. vga30,1080p30 (all)")
    p.add_argument(
        "--into",
        type=Path,
        metavar="PAGE",
        help="Markdown page whose place <!-- bench --> ... <!-- /bench --> is to be rewritten",
    )
    p.add_argument("--quiet", action="store_true", help="no progress bar")
    return p


def measured(options: argparse.Namespace) -> dict[str, Any]:
    """Run the parts asked for and write everything; returns what is in bench.json."""
    options.out.mkdir(parents=True, exist_ok=True)
    quick, quiet = options.quick, options.quiet
    frames = options.frames or (5 if quick else 40)
    seconds = options.seconds or (2 if quick else 10)
    cases = tuple(name for name in options.cases.split(",") if name)
    run: dict[str, Callable[[], dict[str, Any]]] = {
        "core": lambda: core(
            sequences_for(options.data, options.out, frames), frames, quiet, options.models
        ),
        "stages": lambda: _stages(20 if quick else 200),
        "scaling": lambda: scaling(cases_of(quick), 20 if quick else 150, quiet),
        "node": lambda: node(seconds, options.full, cases, quiet),
        "start": lambda: run_case("--how=start") | {"imports": weigh_imports()},
    }
    bench: dict[str, Any] = {
        "date": datetime.date.today().isoformat(),
        "machine": machine(),
        "load": {"before": os.getloadavg()[0]},
    }
    with one_thread():
        for part in options.parts:
            try:
                bench[part] = run[part]()
            except (NodeCaseError, TrackerProcessError) as error:
                # The other parts took minutes, and do not need this one.
                print(f"bench: {part}: {error}", file=sys.stderr)
                bench.setdefault("failed", {})[part] = str(error)
            bench["load"]["after"] = os.getloadavg()[0]
            (options.out / "bench.json").write_text(json.dumps(plain(bench), indent=1) + "\n")
    report.write(bench, plots(bench), options.out)
    if options.into:
        report.update(options.into, bench)
    return bench


def _stages(frames: int) -> dict[str, dict[str, float]]:
    footage = Footage(640, 480)
    box = middle(footage, TARGET_IN_IMAGES)
    configs = {OURS: TrackerConfig(), PAPER: PaperConfig()}
    return {name: stage_times(config, footage, box, frames) for name, config in configs.items()}


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not at least 1")
    return value


def _parts(text: str) -> tuple[str, ...]:
    parts = tuple(text.split(","))
    if unknown := [part for part in parts if part not in PARTS]:
        raise argparse.ArgumentTypeError(f"no part {', '.join(unknown)}; {', '.join(PARTS)}")
    return tuple(part for part in PARTS if part in parts)


if __name__ == "__main__":
    sys.exit(main())
