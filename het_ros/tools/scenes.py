# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Follow rendered stories with exact truth and tell how honest the tracker was.

Each story is rendered from several seeds (street, clothes, gait, shake and noise), followed with
the default configuration and judged: did TRACKING mean that the target was visible, did the box
come back to it, was it ever confident on something else; and how far was the velocity from the
true one. Prints two Markdown tables.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from het_ros.ros.threads import one_thread
from het_ros.scene import STORIES, SceneConfig
from het_ros.scene.honesty import Honesty, followed, honesty
from het_ros.tools import scene_velocity
from het_ros.tools.arguments import add_network, command
from het_ros.tracking.config import TrackerConfig

HIDING = ("hidden_500ms", "hidden_1s", "hidden_2s", "leaves_and_returns")
ALIKE = ("lookalike_at_column", "lookalike_crosses")
LEAST_F = 0.9
# Two cameras, a small slow one and a larger faster one.
CAMERAS = (
    SceneConfig(width=320, height=240, rate=15.0),
    SceneConfig(width=480, height=360, rate=20.0),
)

EXAMPLE = """example:
  ros2 run het_ros scenes --seeds 5
  ros2 run het_ros scenes --stories lookalike_at_column,lookalike_crosses --seeds 20
  ros2 run het_ros scenes --seeds 3 --gray
  ros2 run het_ros scenes --network models/nanotrackv3
"""


def judged(
    config: SceneConfig, tracker_seed: int = 0, gray: bool = False, network: str = ""
) -> tuple[Honesty, dict[str, Any] | None]:
    """Follow one scene; its honesty, and how good its velocity was where that can be said."""
    one_thread()  # scenes run side by side
    moments = followed(config, TrackerConfig(seed=tracker_seed, network=network), gray)
    return honesty(moments, config.rate), scene_velocity.velocity_of(moments, config.rate)


def table(results: Sequence[tuple[SceneConfig, Honesty]]) -> str:
    """Markdown: a row a story, and how many scenes are under F .9 in all."""
    rows = [
        "| story | scenes | end on the target | back after, median | F of visible, mean (least) "
        "| frames confident of something else | on another figure afterwards |",
        "|---|---|---|---|---|---|---|",
    ]
    for story in dict.fromkeys(config.story for config, _ in results):
        rows.append(_row(story, [found for config, found in results if config.story == story]))
    low = sum(found.f_of_visible < LEAST_F for _, found in results)
    return "\n".join([*rows, "", f"F of visible is under {LEAST_F:g} in {low} of {len(results)}."])


def _row(story: str, found: Sequence[Honesty]) -> str:
    visible = [one.f_of_visible for one in found]
    back = [one.back_after for one in found if one.back_after is not None]
    wrong = [one.confident_wrong for one in found if one.confident_wrong]
    other = [one.confident_other for one in found if one.confident_other]
    cells = [
        story,
        str(len(found)),
        str(sum(one.ends_on_target for one in found)),
        f"{np.median(back):.2f} s" if back else "",
        f"{np.mean(visible):.2f} ({min(visible):.2f})",
        *(f"{sum(bad)}, in {len(bad)} of them" if bad else "0" for bad in (wrong, other)),
    ]
    return f"| {' | '.join(cells)} |"


def main(argv: list[str] | None = None) -> int:
    """Command line."""
    p = command("scenes", __doc__, EXAMPLE)
    p.add_argument("--stories", default=",".join((*HIDING, *ALIKE)), help="which, by name")
    p.add_argument("--seeds", type=int, default=5, help="scenes of each story and camera (5)")
    p.add_argument("--first-seed", type=int, default=0, help="the first of them (0)")
    p.add_argument("--tracker-seed", type=int, default=0, help="seed of the tracker (0)")
    p.add_argument("--gray", action="store_true", help="as a camera without colour sees them")
    add_network(p)
    p.add_argument("--jobs", type=int, help="processes (as many as there are processors)")
    p.add_argument("--out", type=Path, help="also write every scene's figures here, JSON")
    options = p.parse_args(argv)
    stories = options.stories.split(",")
    unknown = [story for story in stories if story not in STORIES]
    if unknown or options.seeds < 1:
        p.error(
            f"there is no story {', '.join(unknown)}: give some of {', '.join(STORIES)}"
            if unknown
            else "--seeds must be 1 or more"
        )
    configs = [
        replace(camera, story=story, seed=seed)
        for story in stories
        for camera in CAMERAS
        for seed in range(options.first_seed, options.first_seed + options.seeds)
    ]
    # A fork of a process that has OpenCV's or ROS's threads may hang in their locks.
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool:
        judge = partial(
            judged,
            tracker_seed=options.tracker_seed,
            gray=options.gray,
            network=options.network,
        )
        found = list(tqdm(pool.map(judge, configs), total=len(configs), unit="scene"))
    results = [(config, honest) for config, (honest, _) in zip(configs, found, strict=True)]
    moved = [moves for _, moves in found]
    print(table(results))
    stories_moved = ((config.story, moves) for config, moves in zip(configs, moved, strict=True))
    print(f"\n{scene_velocity.table(stories_moved)}")
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        rows = [
            {"scene": asdict(config), **asdict(one), "velocity": moves}
            for (config, one), moves in zip(results, moved, strict=True)
        ]
        options.out.write_text(json.dumps(rows, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
