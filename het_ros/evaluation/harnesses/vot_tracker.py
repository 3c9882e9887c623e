# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The process that VOT's toolkit starts: a tracker of ours that speaks the TraX protocol."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from trax import Image, Rectangle, Region, Server, TraxStatus

from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.trackers import Tracker, tracker_spec
from het_ros.tracking.box import Box

EXAMPLE = """\
It is the toolkit that starts it; in trackers.ini:
  [het]
  label = het
  protocol = trax
  command = /path/to/python -m het_ros.evaluation.harnesses.vot_tracker het
"""


def serve(server: Any, tracker: Tracker, dt: float) -> None:
    """Answer the toolkit until it says that it is over.

    Args:
        server: a ``trax.Server``.
        tracker: what follows.
        dt: time between two frames, s.
    """
    box: tuple[float, ...] = ()
    while True:
        request = server.wait()
        if request.type not in (TraxStatus.INITIALIZE, TraxStatus.FRAME):
            return
        image = pixels(request.image["color"])
        properties: dict[str, float] = {}
        if request.type == TraxStatus.INITIALIZE:
            box = request.objects[0][0].bounds()  # of a rectangle: x, y, w, h
            tracker.init(image, Box(*box))
        else:
            answer = tracker.update(image, dt)
            box = answer.box or box
            if np.isfinite(answer.score):
                properties["confidence"] = answer.score
        server.status([(Rectangle.create(*box), properties)])


def pixels(image: Any) -> NDArray[np.uint8]:
    """Read a TraX path image as (H, W, 3) uint8 BGR.

    Raises:
        OSError: there is no such image.
    """
    found = cv2.imread(image.path(), cv2.IMREAD_COLOR)
    if found is None:
        raise OSError(f"{image.path()} cannot be read as an image")
    return np.asarray(found, np.uint8)


def main(arguments: list[str] | None = None) -> int:
    """Serve one session of the toolkit."""
    p = argparse.ArgumentParser(
        prog="vot_tracker",
        description=__doc__,
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    p.add_argument("tracker", help="named as for evaluate")
    p.add_argument("--seed", type=int, default=0, help="of a random tracker (0)")
    p.add_argument("--models", type=Path, help="folder of the networks' files")
    p.add_argument("--fps", type=float, default=30.0, help="of the camera (30)")
    options = p.parse_args(arguments)
    spec = tracker_spec(options.tracker, options.models)
    with one_thread(), Server([Region.RECTANGLE], [Image.PATH], tracker_name=spec.name) as server:
        serve(server, spec.build(options.seed), 1 / options.fps)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
