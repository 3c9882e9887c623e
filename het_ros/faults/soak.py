# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Hours in minutes: the installed tracker at a steady rate for long, watched from outside.

A camera in this process plays a rendered street in a loop, with columns, passers-by and new boxes;
the tracker runs in a process of its own, as ``ros2 run het_ros tracker`` starts it. Every few
seconds its memory, files, threads and latencies are looked at. Writes soak.json and soak.png.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any, TextIO

import cv2
import numpy as np
from tqdm import tqdm

from het_ros.bench.camera import spun
from het_ros.bench.figures import percentiles, plain
from het_ros.faults.loop import Shot, render
from het_ros.faults.process import Sample, look
from het_ros.faults.soak_camera import SoakCamera, Stretch
from het_ros.faults.soak_plot import plot
from het_ros.faults.verdict import judge
from het_ros.scene.config import SceneConfig
from het_ros.tools.arguments import INTERRUPTED, add_parameters, command
from het_ros.tools.handshake import NobodyListensError, Spin, meet
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.tracker_arguments import parameter_arguments
from het_ros.tools.tracker_process import (
    TrackerProcess,
    TrackerProcessError,
    find_tracker,
    own_graph,
)

PATIENCE = 60.0  # s, for camera and tracker to find each other
STRETCHES = 360  # rows of a run at most, each LEAST_STRETCH or longer
LEAST_STRETCH = 2.0  # s
CATCH_UP = 0.8  # of the time between two frames is kept even when the camera is late
LONGEST_LAG = 1.0  # s that are caught up with
CALLBACKS = 8  # served a frame before the time is looked at

EXAMPLE = """examples:
  ros2 run het_ros soak --minutes 60 --out out/soak
  ros2 run het_ros soak --minutes 2 --size 1280x720 -p sub_patches:=5
"""


def soak(
    seconds: float,
    shots: list[Shot],
    folder: Path,
    stop: StopRequest,
    *,
    rate: float = 30.0,
    seed: int = 0,
    arguments: tuple[str, ...] = (),
) -> list[dict[str, Any]]:
    """Run it; one row a stretch.

    Args:
        seconds: how long.
        shots: the loop to play.
        folder: for ``tracker.log`` and ``rows.jsonl``, which is there however a run ends.
        stop: ends it early.
        rate: frames/s.
        seed: of the moments of new boxes.
        arguments: of the tracker.

    Raises:
        TrackerProcessError: the tracker ended by itself.
        NobodyListensError: it cannot be heard.
    """
    os.environ.update(own_graph())
    with (
        TrackerProcess(find_tracker(), arguments, folder / "tracker.log") as tracker,
        spun(lambda: SoakCamera(shots, rate, np.random.default_rng(seed))) as (camera, spin),
    ):
        meet(camera, camera.tracker, camera.connected, spin, PATIENCE, stop, tracker.check)
        with (folder / "rows.jsonl").open("w") as file:
            return _watched(camera, spin, tracker, seconds, stop, file)


def _watched(
    camera: SoakCamera,
    spin: Spin,
    tracker: TrackerProcess,
    seconds: float,
    stop: StopRequest,
    file: TextIO,
) -> list[dict[str, Any]]:
    stretch = max(seconds / STRETCHES, LEAST_STRETCH)
    rows: list[dict[str, Any]] = []
    camera.begin()
    begun = due = time.monotonic()
    before = look(tracker.pid)
    with tqdm(total=round(seconds), desc="soak", unit="s", mininterval=5) as progress:
        while not stop and time.monotonic() - begun < seconds:
            camera.publish()
            # After a hold-up it catches up little by little: no camera sends images in bursts.
            due = max(due, time.monotonic() - LONGEST_LAG) + 1 / camera.rate
            next_one = max(due, time.monotonic() + CATCH_UP / camera.rate)
            for _ in range(CALLBACKS):
                spin(0.0)
            while (left := next_one - time.monotonic()) > 0:
                spin(left)
            if time.monotonic() - before.time >= stretch:
                tracker.check()
                now = look(tracker.pid)
                rows.append(row_of(camera.take_stretch(), camera.counts, before, now, begun))
                file.write(json.dumps(plain(rows[-1])) + "\n")
                file.flush()
                before = now
                progress.update(round(now.time - begun) - progress.n)
    return rows


def row_of(
    stretch: Stretch, counts: dict[str, int], before: Sample, now: Sample, begun: float
) -> dict[str, Any]:
    """One row of soak.json; ``time`` is s since the start, ``counted`` what /diagnostics says."""
    answered = len(stretch.own)
    own, trips, probe = (percentiles(t) for t in (stretch.own, stretch.trips, stretch.probe))
    return {
        **asdict(now),
        "time": now.time - begun,
        "sent": stretch.sent,
        "answered": answered,
        "boxes": stretch.boxes,
        **{state: stretch.states[state] for state in ("IDLE", "TRACKING", "COASTING", "LOST")},
        "visible": stretch.visible,
        "right": stretch.right,
        "silence": stretch.silence,
        **own,
        **{f"trip_{name}": value for name, value in trips.items()},
        **{f"probe_{name}": value for name, value in probe.items()},
        "cpu_ms_a_frame": 1e3 * (now.cpu - before.cpu) / max(answered, 1),
        "counted": dict(counts),
    }


def main(argv: list[str] | None = None) -> int:
    """0: all that is asked for is met; 1: it is not; 2: it could not be run; 130: stopped."""
    p = command("soak", __doc__, EXAMPLE)
    p.add_argument("--minutes", type=float, default=60.0, help="how long (60)")
    p.add_argument("--out", type=Path, default=Path("out/soak"), help="results folder")
    p.add_argument("--rate", type=float, default=30.0, help="frames/s (30)")
    p.add_argument("--size", default="640x480", help="of the images (640x480)")
    p.add_argument("--loop", type=float, default=0.0, help="s of the loop (0: the whole story)")
    p.add_argument("--seed", type=int, default=0, help="of street and boxes (0)")
    add_parameters(p)
    options = p.parse_args(argv)
    try:
        return _run(options)
    except (OSError, ValueError, TrackerProcessError, NobodyListensError) as error:
        print(f"soak: {error}", file=sys.stderr)
        return 2


def _run(options: argparse.Namespace) -> int:
    if not (0 < options.minutes < float("inf") and 0 < options.rate <= 240):
        raise ValueError("--minutes takes a number over 0, --rate one over 0 and up to 240")
    width, height = (int(side) for side in options.size.split("x"))
    options.out.mkdir(parents=True, exist_ok=True)
    cv2.setNumThreads(1)
    config = SceneConfig(width=width, height=height, rate=options.rate, seed=options.seed)
    given = parameter_arguments(options.parameters)
    with StopRequest() as stop:
        rows = soak(
            60 * options.minutes,
            render(config, round(options.loop * options.rate)),
            options.out,
            stop,
            rate=options.rate,
            seed=options.seed,
            arguments=("--ros-args", *given) if given else (),
        )
    asked = {name: str(value) for name, value in vars(options).items()}
    result = {"asked": asked, **judge(rows), "stopped": bool(stop), "rows": rows}
    (options.out / "soak.json").write_text(json.dumps(plain(result), indent=1))
    plot(rows, options.out / "soak.png")
    print("\n".join([*told(result), f"results   {options.out}"]))
    return INTERRUPTED if stop else int(not result["passed"])


def told(result: dict[str, Any]) -> list[str]:
    """The result in words."""
    f = result["figures"]
    lines = [
        f"{f['seconds'] / 60:.1f} minutes at {f['rate']:.1f} frames/s, {f['sent']} sent, "
        f"{f['answered_share']:.1%} answered, {f['boxes']} boxes",
        f"memory    {f['rss_mb'][0]:.1f} to {f['rss_mb'][1]:.1f} MB ({f['rss_growth']:+.2%}), "
        f"its own {f['own_mb'][0]:.1f} to {f['own_mb'][1]:.1f} MB ({f['own_growth']:+.2%})",
        f"latency   p99 {f['p99_ms'][0]:.1f} to {f['p99_ms'][1]:.1f} ms "
        f"({f['p99_drift']:+.1%}; {f['p99_drift_relative']:+.1%} relative to the machine)",
        f"files     {f['files'][0]} to {f['files'][1]}, threads {f['threads']}",
        f"states    TRACKING {f['tracking']}, COASTING {f['coasting']}, LOST {f['lost']}; "
        f"{f['right_share']:.1%} of visible frames on the target",
        f"load      {f['load_median']:.1f} (median), {f['load_max']:.1f} (most)",
    ]
    lines += [f"{'met ' if c['met'] else 'MISSED'}    {c['what']}" for c in result["checks"]]
    return [*lines, "PASSED" if result["passed"] else "FAILED"]


if __name__ == "__main__":
    sys.exit(main())
