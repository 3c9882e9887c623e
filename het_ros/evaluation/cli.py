# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The executable ``evaluate``."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from het_ros.evaluation import (
    evidence_tables,
    other_boxes,
    pages,
    published,
    raw_boxes,
    report,
    tables,
)
from het_ros.evaluation.cache import Cache
from het_ros.evaluation.choice import chosen
from het_ros.evaluation.compare import compare
from het_ros.evaluation.drawing import colours
from het_ros.evaluation.jobs import DIED, SourceChangedError
from het_ros.evaluation.plots import plots
from het_ros.evaluation.protocols import PROTOCOLS
from het_ros.evaluation.readers import add_sequences, read_sequences
from het_ros.evaluation.runs import Plan, Run, carry_out_plan
from het_ros.evaluation.strips import strips
from het_ros.evaluation.summary import Scored, score_runs, summarise
from het_ros.evaluation.timing import Timing, time_trackers
from het_ros.evaluation.trackers import DEFAULT
from het_ros.evaluation.video import write_videos

EXAMPLE = """\
examples:
  ros2 run het_ros evaluate --data ../shared/sequences --out out/dev --seeds 3
  ros2 run het_ros evaluate --data ../shared/sequences --out out/try \\
      --sequences Crossing,Woman --timing 0 \\
      --trackers het,het:sub_patches=5,small@het:small.yaml,csrt
  evaluate --compare out/before out/after
  evaluate --compare out/try:het out/try:small --out out/difference
  evaluate --data ../shared/sequences --out out/peers --models ../shared/models --seeds 3
  evaluate --data ../shared/sequences --out out/beside --boxes EFSCF=efscf/OTB100
"""


def main(arguments: list[str] | None = None) -> int:
    """Run a comparison; 0 when it came through, 2 when it was asked for wrongly."""
    options = parser().parse_args(arguments)
    try:
        if options.compare:
            before, after = options.compare
            return compare(before, after, options.out, options.data)
        if not options.data or not options.out:
            raise ValueError("--data and --out are needed, or --compare A B")
        return evaluate(options)
    except (ValueError, OSError, SourceChangedError) as error:
        print(f"evaluate: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("evaluate: stopped; the same command goes on from here", file=sys.stderr)
        return 130


def parser() -> argparse.ArgumentParser:
    """The command line."""
    p = argparse.ArgumentParser(
        prog="evaluate",
        description="Measure trackers on sequences with ground truth, all in one run.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_sequences(p, required=False)
    p.add_argument("--out", type=Path, help="folder for results and cache")
    p.add_argument(
        "--compare",
        nargs=2,
        metavar=("A", "B"),
        help="run nothing; print the paired difference B - A of two results folders, each "
        "FOLDER or FOLDER:TRACKER (its first tracker); into B/compare, or --out",
    )
    p.add_argument(
        "--trackers",
        default="",
        help="comma-separated; het:field=value,... or name@het:file.yaml for a configuration "
        f"(default: {','.join(DEFAULT)}, and those of --models)",
    )
    p.add_argument(
        "--models",
        type=Path,
        help="folder with ONNX files of NanoTrack and VitTrack: adds nanotrack-v2, "
        "nanotrack-v3, vit, vit-corrected",
    )
    p.add_argument("--seeds", type=_positive, default=1, help="seeds of random trackers (1)")
    p.add_argument("--protocol", choices=PROTOCOLS, default="ope", help="(ope)")
    p.add_argument(
        "--fps", default="", help="frame rates: 30, or 30,NAME=10 (default: the data's, or 30)"
    )
    p.add_argument("--cameras", default="20,30,60", help="frames/s for realtime (20,30,60)")
    p.add_argument(
        "--jobs",
        type=_positive,
        default=os.cpu_count() or 1,
        help="processes on this machine (as many as it has processors); timing runs alone",
    )
    p.add_argument("--scheduler", default="", help="Dask scheduler, tcp://host:8786")
    p.add_argument(
        "--timing",
        type=int,
        default=40,
        metavar="FRAMES",
        help="frames a sequence that are timed, trackers side by side (40); 0: no timing, "
        "the speed is then a rough one from the scored runs",
    )
    p.add_argument("--published", type=Path, help="JSON of published figures to show beside")
    p.add_argument(
        "--published-except",
        default="",
        metavar="SEQUENCES",
        help="comma-separated; sequences of DATA that are not the published ones",
    )
    p.add_argument(
        "--boxes",
        action="append",
        default=[],
        metavar="NAME=FOLDER",
        help="boxes of another tracker, FOLDER/SEQUENCE.txt in OTB's text (x,y,w,h a line, "
        "counted from 1), to be scored beside ours; may be given several times",
    )
    p.add_argument("--video", action="store_true", help="one annotated MP4 a sequence")
    p.add_argument(
        "--into",
        type=Path,
        action="append",
        default=[],
        metavar="PAGE",
        help="Markdown page whose tables between <!-- evaluate: Trackers, AUC by sequence --> "
        "and <!-- /evaluate --> are to be rewritten; may be given several times",
    )
    p.add_argument("--quiet", action="store_true", help="no progress bar")
    return p


def evaluate(options: argparse.Namespace) -> int:
    """Plan, run, score and report."""
    names = tuple(name for name in options.sequences.split(",") if name)
    choice = chosen(options.trackers, options.models)
    for note in choice.notes:
        print(f"evaluate: {note}", file=sys.stderr)
    plan = Plan(
        trackers=choice.trackers,
        sequences=read_sequences(options.data, names, _rates(options.fps)),
        protocol=options.protocol,
        seeds=options.seeds,
        cameras=_cameras(options.cameras),
    )
    if options.published:
        published.read(options.published)  # complain now, not after hours
    others = _others(options, plan)
    cache = Cache(options.out / "cache")
    runs = carry_out_plan(plan, cache, options.jobs, options.scheduler, options.quiet)
    timing = Timing()
    if options.timing > 0:
        folder = options.out / "cache" / "timing"
        dead = {(run.tracker, run.sequence) for run in runs if run.track.error == DIED}
        timing = time_trackers(
            plan.trackers, plan.sequences, options.timing, folder, dead, options.quiet
        )
    scored = score_runs(runs, plan.sequences)
    results = summarise(plan, scored, timing) | {
        "data": str(options.data.resolve()),
        "notes": choice.notes,
        "boxes": others,
    }
    options.out.mkdir(parents=True, exist_ok=True)
    (options.out / "results.json").write_text(
        json.dumps(results, indent=1, allow_nan=False) + "\n"
    )
    raw_boxes.write(runs, {t.name: t.folder for t in plan.trackers}, options.out / "boxes")
    print(tables.summary(results).markdown())
    for file in _report(options, plan, runs, scored, results):
        print(file)
    return 0


def _others(options: argparse.Namespace, plan: Plan) -> dict[str, Any]:
    folders = other_boxes.named(options.boxes)
    if folders and plan.protocol != "ope":
        raise ValueError("--boxes goes with --protocol ope: boxes of one run from the first frame")
    return other_boxes.scored(folders, plan.sequences, options.published_except.split(","))


def _report(
    options: argparse.Namespace,
    plan: Plan,
    runs: list[Run],
    scored: list[Scored],
    results: tables.Results,
) -> Iterator[Path]:
    """Write what people look at; each file is handed back as soon as it is there."""
    yield options.out / "results.json"
    best_first = tables.ranked(results)
    palette = colours([tracker.name for tracker in plan.trackers])
    comparison = None
    if options.published:
        excluded = options.published_except.split(",")
        comparison = published.compare(options.published, results, excluded)
    drawn = plots(results, palette)
    listed = tables.tables(results, comparison) + evidence_tables.tables(results)
    listed += other_boxes.tables(results["boxes"], results)
    for page in options.into:
        pages.update(page, results, listed)
        yield page
    yield report.write_markdown(results, listed, drawn, options.out)
    pictures = strips(scored, plan.sequences, best_first, palette)
    yield report.write_html(results, listed, drawn, pictures, palette, options.out)
    if options.video:
        folder = options.out / "video"
        yield from write_videos(runs, plan.sequences, palette, folder, options.quiet)


def _rates(text: str) -> dict[str, float]:
    rates = {}
    for part in filter(None, text.split(",")):
        name, _, value = part.rpartition("=")
        rates[name] = _rate(value, "--fps takes 30, or 30,NAME=10")
    return rates


def _cameras(text: str) -> tuple[float, ...]:
    return tuple(_rate(part, "--cameras takes rates like 20,30,60") for part in text.split(","))


def _rate(text: str, what: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0 < rate < float("inf"):
        raise ValueError(f"{what}, in frames/s, not {text!r}")
    return rate


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("needs 1 or more")
    return value


if __name__ == "__main__":
    sys.exit(main())
