"""From a recording to things to look at: track.csv, track.mp4, track.png and a summary."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from het_ros.evaluation.metrics import Score, score
from het_ros.tools.bag_reader import BagReader
from het_ros.tools.drawing import annotate
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.outputs import DEFAULT_TRACKER, read_answers, read_latencies
from het_ros.tools.plot import plot_track
from het_ros.tools.results import Row, write_csv
from het_ros.tools.video import VideoWriter
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import State

STRIP_FRAMES = 10
NO_BOX = (np.nan,) * 4


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


@dataclass(frozen=True)
class Summary:
    """How a run went.

    Attributes:
        sent: frames that the tracker was given.
        answered: frames for which it gave a status.
        seconds: time spent in each state, s.
        latencies: from the arrival of a frame to its answer, ms.
        score: against the ground truth; None without any.
    """

    sent: int
    answered: int
    seconds: dict[str, float]
    latencies: NDArray[np.float64]
    score: Score | None

    @property
    def answered_share(self) -> float:
        """Share of frames with an answer, 0..1."""
        return self.answered / self.sent if self.sent else 0.0

    def lines(self) -> list[str]:
        """The summary as text."""
        spent = ", ".join(f"{state} {seconds:.1f} s" for state, seconds in self.seconds.items())
        lines = [
            f"frames    {self.sent} sent, {self.answered} answered ({self.answered_share:.1%})",
            f"states    {spent or 'none'}",
        ]
        if len(self.latencies):
            median, most = np.percentile(self.latencies, (50, 95))
            lines.append(f"latency   {median:.1f} ms (median), {most:.1f} ms (95 %)")
        if self.score:
            lines.append(
                f"accuracy  mean IoU {self.score.mean_overlap:.3f}, centre within 20 px in "
                f"{self.score.p20:.1%} of {self.score.frames} frames"
            )
        return lines


def write_report(
    source: BagReader,
    stamps: Sequence[int],
    folder: ResultsFolder,
    tracker: str = DEFAULT_TRACKER,
) -> Summary:
    """Write CSV, MP4 and PNG of a recording in ``folder.bag``.

    Ctrl-C ends the video early; all files are readable even so.

    Args:
        source: the bag that was played.
        stamps: header stamps of the frames that were sent, ns.
        folder: holds the recording and takes the results.
        tracker: full name of the tracker's node.
    """
    rows = read_answers(folder.bag, stamps, tracker)
    write_csv(rows, folder.csv)
    truth_by_stamp = source.truth()
    truth = [truth_by_stamp.get(row.stamp) for row in rows]
    with StopRequest() as stop:
        strip = _write_video(source, rows, truth, folder.video, stop)
    summary = _summarise(rows, truth, read_latencies(folder.bag, tracker))
    title = f"{source.path.name}: {summary.sent} frames, {summary.answered_share:.0%} answered"
    if summary.score:
        title += f", mean IoU {summary.score.mean_overlap:.2f}"
    plot_track(folder.picture, rows, truth, strip, title)
    return summary


def _write_video(
    source: BagReader,
    rows: Sequence[Row],
    truth: Sequence[Box | None],
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
    with VideoWriter(path, _usual_rate(rows)) as video, progress:
        for stamp, image in source.images():
            index = index_of.get(stamp)
            if stop:
                break
            if index is None:
                continue
            canvas = annotate(image, rows[index], truth[index])
            video.add(canvas, stamp)
            progress.update()
            if index in wanted:
                strip.append((index, canvas))
            if index == len(rows) - 1:
                break
    return strip


def _usual_rate(rows: Sequence[Row]) -> float:
    """Frames/s by the median distance of stamps."""
    steps = np.diff([row.stamp for row in rows]) * 1e-9
    usual = float(np.median(steps)) if len(steps) else 0.0
    return min(1 / usual, 1000.0) if usual > 0 else 30.0


def _summarise(
    rows: Sequence[Row], truth: Sequence[Box | None], latencies: NDArray[np.float64]
) -> Summary:
    step = 1 / _usual_rate(rows)
    counts = {state: sum(row.state is state for row in rows) for state in State}
    return Summary(
        sent=len(rows),
        answered=sum(row.state is not None for row in rows),
        seconds={state.value: n * step for state, n in counts.items() if n},
        latencies=latencies,
        score=_score(rows, truth),
    )


def _score(rows: Sequence[Row], truth: Sequence[Box | None]) -> Score | None:
    """Score as the benchmark does, from the first true box on."""
    first = next((i for i, box in enumerate(truth) if box), None)
    if first is None or not any(row.box for row in rows):
        return None
    boxes = np.array([row.box.as_tuple() if row.box else NO_BOX for row in rows[first:]])
    true = np.array([box.as_tuple() if box else NO_BOX for box in truth[first:]])
    return score(boxes, true)
