# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The core beside OpenCV's trackers: the same frames, one thread, taking turns."""

from __future__ import annotations

import itertools
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.bench.allocations import peak_of_a_frame
from het_ros.bench.figures import percentiles, speed_over
from het_ros.bench.floor import floor, sizes_of
from het_ros.bench.footage import Footage, middle
from het_ros.bench.scaling import TARGET_IN_IMAGES
from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.opencv_peers import PEERS, available
from het_ros.evaluation.readers import read_sequences
from het_ros.evaluation.sequences import Frames, Sequence
from het_ros.evaluation.timing import time_trackers
from het_ros.evaluation.trackers import WITH_NETWORK, tracker_spec
from het_ros.scene import Scene, SceneConfig
from het_ros.tracking.bottom.second_thread import processors
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

OURS = "het"
PAPER = "het-paper"
ALONE = "nanotrack-v3"  # the network of WITH_NETWORK, and nothing else
TWO_THREADS = f"{WITH_NETWORK} on two threads"
COMPARED = ("csrt", "kcf", "mil", "boosting", "medianflow", "mosse")
WARM_UP = 2  # updates that are not counted: they make the buffers
RENDERED = "rendered street"

Floats = NDArray[np.float64]
Times = Mapping[tuple[str, str], Floats]


def sequences_for(data: Path | None, out: Path, frames: int) -> list[Sequence]:
    """The sequences of a folder; without one a rendered street, written to ``out/rendered``.

    Raises:
        ValueError: the folder holds no sequence.
    """
    if data is not None:
        return read_sequences(data)
    scene = Scene(SceneConfig())
    folder = out / "rendered"
    folder.mkdir(parents=True, exist_ok=True)
    files, boxes = [], []
    for i in range(min(frames + 1, len(scene))):
        frame = scene.frame(i)
        file = folder / f"{i:05d}.png"
        cv2.imwrite(str(file), frame.image)
        files.append(str(file))
        boxes.append(frame.box.as_tuple() if frame.box else (np.nan,) * 4)
    return [Sequence(RENDERED, Frames(tuple(files), scene.config.rate), np.array(boxes))]


def core(
    sequences: list[Sequence], frames: int, quiet: bool = False, models: Path | None = None
) -> dict[str, Any]:
    """Time this tracker, the paper's configuration and every peer that this OpenCV has.

    Args:
        sequences: what they follow.
        frames: updates timed on each sequence.
        quiet: no progress bar.
        models: folder of the networks' files, with which this tracker is timed as well, on one
            thread and on two, and the network alone; None leaves them out.

    Raises:
        ValueError: the folder has no such network.
    """
    two = f"{TWO_THREADS}@{WITH_NETWORK}:network_thread=true"
    with_network = (WITH_NETWORK, two, ALONE) if models else ()
    peers = (name for name in COMPARED if name in available())
    specs = [tracker_spec(name, models) for name in (OURS, PAPER, *with_network, *peers)]
    names = [spec.name for spec in specs]
    # A place of its own: what an earlier run measured is of another machine or another day.
    with tempfile.TemporaryDirectory() as folder:
        timing = time_trackers(specs, sequences, frames, Path(folder), quiet=quiet)
    seconds = {key: times[WARM_UP:] for key, times in timing.seconds.items()}
    found = summary(seconds, names, [sequence.name for sequence in sequences])
    footage = Footage(640, 480)
    box = middle(footage, TARGET_IN_IMAGES)
    found |= _beside_the_floor(TrackerConfig(), footage, box)
    found["frame_allocations_mb"] = peak_of_a_frame(TrackerConfig(), footage, box)
    found |= {"frames": frames, "load": timing.load, "processors": processors()}
    return found


def _network_figures(of: Callable[[str], list[Floats]], csrt: list[Floats]) -> dict[str, float]:
    medians = (
        [float(np.nanmedian(times)) for times in of(name)] for name in (TWO_THREADS, OURS, ALONE)
    )
    over = [two / max(ours, alone) for two, ours, alone in zip(*medians, strict=True)]
    return {
        "speed_over_csrt": speed_over(of(WITH_NETWORK), csrt),
        "time_over_slower": float(np.median(over)),
    }


def _beside_the_floor(config: TrackerConfig, footage: Footage, box: Box) -> dict[str, Any]:
    """The floor's passes and the ratios of a frame to them, on one thread."""
    tracker = HierarchicalEnsembleTracker(config)
    tracker.init(footage[0], box)
    images = (footage[i] for i in itertools.count(1))
    with one_thread():
        passes = floor(sizes_of(config), lambda: tracker.update(next(images), 1 / 30))
    frame, least = passes["frame_ms"], passes["total_ms"]
    return {
        "floor": passes,
        "ratio_to_floor": frame / least,
        "ratio_to_floor_with_learning": frame / (least + passes["learning_product_ms"]),
    }


def summary(seconds: Times, names: list[str], sequences: list[str]) -> dict[str, Any]:
    """The figures of timed updates.

    Args:
        seconds: times of the updates, s, by (tracker, sequence); NaN where one failed.
        names: the trackers, the first of them this one.
        sequences: the sequences.

    Returns:
        ``trackers``: percentiles of all updates of each, and how many times faster this tracker
        is; ``sequences``: median ms by sequence and tracker; the percentiles of this tracker;
        ``p99_over_p50`` over all its updates, and ``p99_over_p50_by_sequence``, the median of
        what it is on each sequence alone; ``speed_over_csrt`` and ``paper_speed_over_csrt``;
        ``network``, where it was timed: ``speed_over_csrt`` of one thread, and of two their
        ``time_over_slower``, that of this tracker or of the network alone.
    """

    def of(name: str) -> list[Floats]:
        return [seconds[name, sequence] for sequence in sequences]

    ours, paper = of(OURS), of(PAPER)
    own = percentiles(np.concatenate(ours))
    spread = [percentiles(times) for times in ours]
    nothing = [np.array([np.nan])] * len(sequences)
    csrt = of("csrt") if "csrt" in names else nothing
    network = _network_figures(of, csrt) if WITH_NETWORK in names else {}
    return {
        **own,
        "network": network,
        "p99_over_p50": own["p99_ms"] / own["p50_ms"],
        "p99_over_p50_by_sequence": float(np.median([s["p99_ms"] / s["p50_ms"] for s in spread])),
        "speed_over_csrt": speed_over(ours, csrt),
        "paper_speed_over_csrt": speed_over(paper, csrt),
        "paper": percentiles(np.concatenate(paper)),
        "trackers": {
            name: {
                **percentiles(np.concatenate(of(name))),
                "het_is_faster_by": speed_over(ours, of(name)),
                "paper_is_faster_by": speed_over(paper, of(name)),
            }
            for name in names
        },
        "sequences": {
            sequence: {name: percentiles(seconds[name, sequence])["p50_ms"] for name in names}
            for sequence in sequences
        },
        "absent_peers": [name for name in COMPARED if name not in names and name in PEERS],
    }
