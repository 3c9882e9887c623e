# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From a recording to things to look at: track.csv, track.mp4, track.png and a summary."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from het_ros.tools.bag_reader import BagReader
from het_ros.tools.drawing import annotate
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.outputs import DEFAULT_TRACKER, read_answers, read_latencies
from het_ros.tools.plot import plot_track
from het_ros.tools.results import Row, write_csv
from het_ros.tools.summary import Summary, Truth, summarise, usual_rate
from het_ros.tools.video import VideoWriter

STRIP_FRAMES = 10


@dataclass(frozen=True)
class ResultsFolder:
    """Where results go: ``bag/``, ``track.csv``, ``track.mp4``, ``track.png``."""

    path: Path

    @property
    def bag(self) -> Path:
        """The tracker's outputs as a bag."""
        return self.path / "bag"

    @property
    def csv(self) -> Path:
        """One row a frame."""
        return self.path / "track.csv"

    @property
    def video(self) -> Path:
        """The annotated frames."""
        return self.path / "track.mp4"

    @property
    def picture(self) -> Path:
        """Strip and plots."""
        return self.path / "track.png"

    def clear(self) -> None:
        """Make the folder and remove the results of an earlier run, and nothing else."""
        self.path.mkdir(parents=True, exist_ok=True)
        for file in (self.csv, self.video, self.picture):
            file.unlink(missing_ok=True)
        remove_bag(self.bag)


def remove_bag(path: Path) -> None:
    """Remove a bag's folder if it is one.

    Raises:
        FileExistsError: something else is there.
    """
    if not path.exists():
        return
    strange = [
        file for file in path.glob("*") if not file.name.startswith(("metadata.yaml", path.name))
    ]
    if not path.is_dir() or strange:
        raise FileExistsError(f"{path} is no bag of an earlier run: choose another folder")
    shutil.rmtree(path)


def write_report(
    source: BagReader,
    stamps: Sequence[int],
    folder: ResultsFolder,
    *,
    tracker: str = DEFAULT_TRACKER,
    name: str = "",
) -> Summary:
    """Write CSV, MP4 and PNG of a recording in ``folder.bag``.

    Ctrl-C ends the video early; all files are readable even so.

    Args:
        source: the bag that was played.
        stamps: header stamps of the frames that were sent, ns.
        folder: holds the recording and takes the results.
        tracker: full name of the tracker's node.
        name: what was played, for the picture's title; by default the bag's folder.
    """
    rows = read_answers(folder.bag, stamps, tracker)
    write_csv(rows, folder.csv)
    boxes, visible = source.truth(), source.visibility()
    truth = [Truth(boxes.get(row.stamp), visible.get(row.stamp, 1.0)) for row in rows]
    with StopRequest() as stop:
        strip = _write_video(source, rows, truth, folder.video, stop)
    summary = summarise(rows, truth, read_latencies(folder.bag, tracker))
    title = (
        f"{name or source.path.name}: {summary.sent} frames, {summary.answered_share:.0%} answered"
    )
    if summary.score:
        title += f", mean IoU {summary.score.mean_overlap:.2f}"
    plot_track(folder.picture, rows, truth, strip, title)
    return summary


def _write_video(
    source: BagReader,
    rows: Sequence[Row],
    truth: Sequence[Truth],
    path: Path,
    stop: StopRequest,
) -> list[tuple[int, NDArray[np.uint8]]]:
    """Annotate every frame into the MP4; return the ones for the strip with their index."""
    if not rows:
        return []
    wanted = set(np.linspace(0, len(rows) - 1, STRIP_FRAMES).round().astype(int).tolist())
    strip = []
    index_of = {row.stamp: index for index, row in enumerate(rows)}
    progress = tqdm(total=len(rows), desc="track.mp4", unit="frame", delay=2)
    with VideoWriter(path, usual_rate(rows)) as video, progress:
        for stamp, image in source.images():
            index = index_of.get(stamp)
            if stop:
                break
            if index is None:
                continue
            canvas = annotate(image, rows[index], truth[index].box)
            video.add(canvas, stamp)
            progress.update()
            if index in wanted:
                strip.append((index, canvas))
            if index == len(rows) - 1:
                break
    return strip
