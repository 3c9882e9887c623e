# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""GOT-10k's toolkit runs a tracker of ours, or scores boxes that ``evaluate`` wrote."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from got10k.experiments import ExperimentUAV123
from got10k.trackers import Tracker
from numpy.typing import NDArray

from het_ros.evaluation.jobs import one_thread
from het_ros.evaluation.raw_boxes import FIRST_PIXEL
from het_ros.evaluation.readers import add_sequences, read_sequences
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.trackers import TrackerSpec, tracker_spec
from het_ros.tracking.box import Box

EXAMPLE = """\
examples:
  python -m het_ros.evaluation.harnesses.got10k_toolkit --data ../shared/sequences \\
      --out out/got10k --tracker het --sequences Crossing,Skiing
  python -m het_ros.evaluation.harnesses.got10k_toolkit --data ../shared/sequences \\
      --out out/got10k --evaluated out/evaluate
"""


class Got10kTracker(Tracker):  # type: ignore[misc]  # the toolkit has no types
    """A tracker of ours as the toolkit's tracker class.

    Args:
        spec: the tracker.
        seed: of a random one.
        first_pixel: what the data set calls the top-left pixel: 1 in OTB, else 0.
        dt: time between two frames, s.
    """

    def __init__(
        self, spec: TrackerSpec, seed: int = 0, first_pixel: int = 0, dt: float = 1 / 30
    ) -> None:
        super().__init__(name=spec.folder, is_deterministic=not spec.random)
        self._tracker = spec.build(seed)
        self._offset = FIRST_PIXEL * first_pixel
        self._dt = dt

    def init(self, image: Any, box: NDArray[np.float64]) -> None:
        """Start on x, y, w, h of an RGB picture (PIL's)."""
        self._box = np.asarray(box, np.float64)
        self._tracker.init(_bgr(image), Box(*(self._box - self._offset)))

    def update(self, image: Any) -> NDArray[np.float64]:
        """X, y, w, h in the next picture; the box before where the tracker gives none."""
        answer = self._tracker.update(_bgr(image), self._dt)
        if answer.box is not None:
            self._box = np.array(answer.box) + self._offset
        return self._box


def _bgr(image: Any) -> NDArray[np.uint8]:
    return np.ascontiguousarray(np.asarray(image, np.uint8)[:, :, ::-1])


class Listed:
    """Sequences as the toolkit's data set: pairs of image files and boxes counted from 1."""

    def __init__(self, sequences: list[Sequence]) -> None:
        self._sequences = sequences
        self.seq_names = [sequence.name for sequence in sequences]

    def __len__(self) -> int:
        return len(self._sequences)

    def __getitem__(self, index: int | str) -> tuple[list[str], NDArray[np.float64]]:
        row = self.seq_names.index(index) if isinstance(index, str) else index
        sequence = self._sequences[row]  # its IndexError ends the toolkit's loops
        return list(sequence.frames.files), sequence.truth + FIRST_PIXEL


class Experiment(ExperimentUAV123):  # type: ignore[misc]
    """The toolkit's one-pass evaluation on sequences of any name.

    The figures are OTB's; as with UAV123, frames without a valid true box are left out.
    """

    def __init__(self, sequences: list[Sequence], out: Path) -> None:
        self.dataset = Listed(sequences)
        self.result_dir, self.report_dir = str(out / "results"), str(out / "reports")
        self.nbins_iou, self.nbins_ce = 21, 51


def compare(
    performance: dict[str, Any], results: dict[str, Any], folders: dict[str, str]
) -> Iterator[str]:
    """Lines of the toolkit's figures beside ours.

    Args:
        performance: what the toolkit's ``report`` gives.
        results: the content of our ``results.json``.
        folders: the folder's name of each of our trackers.
    """
    yield "tracker  AUC toolkit/ours  P20 toolkit/ours  largest difference of a sequence"
    for name, folder in folders.items():
        theirs, ours = performance[folder], results["trackers"][name]
        apart = [
            abs(theirs["seq_wise"][s][key] - ours["sequences"][s][figure])
            for s in theirs["seq_wise"]
            for key, figure in (("success_score", "auc"), ("precision_score", "p20"))
        ]
        overall = theirs["overall"]
        yield (
            f"{name}  {overall['success_score']:.4f}/{ours['auc']:.4f}  "
            f"{overall['precision_score']:.4f}/{ours['p20']:.4f}  {max(apart):.4f}"
        )


def take_over(evaluated: Path, results: dict[str, Any], out: Path) -> dict[str, str]:
    """Copy the boxes that ``evaluate`` wrote to where the toolkit looks for them.

    Only trackers that ran once are comparable: of the others the figures are means over seeds.

    Returns:
        The folder's name of each tracker that was taken.
    """
    folders = {}
    for name, figures in results["trackers"].items():
        folder = TrackerSpec(name, Tracker, "").folder
        if figures["seeds"] == 1:
            folders[name] = folder
            shutil.copytree(
                evaluated / "boxes" / folder, out / "results" / folder, dirs_exist_ok=True
            )
    return folders


def main(arguments: list[str] | None = None) -> int:
    """Run or score; 0 when it came through, 2 when it was asked for wrongly."""
    p = argparse.ArgumentParser(
        prog="got10k_toolkit",
        description=__doc__,
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_sequences(p)
    p.add_argument("--out", type=Path, required=True, help="the toolkit's results and reports")
    p.add_argument("--models", type=Path, help="folder of the networks' files")
    how = p.add_mutually_exclusive_group(required=True)
    how.add_argument("--tracker", help="run this one, named as for evaluate")
    how.add_argument(
        "--evaluated", type=Path, help="score what evaluate wrote there, of the same sequences"
    )
    options = p.parse_args(arguments)
    try:
        return _run(options)
    except (ValueError, OSError) as error:
        print(f"got10k_toolkit: {error}", file=sys.stderr)
        return 2


def _run(options: argparse.Namespace) -> int:
    names = tuple(name for name in options.sequences.split(",") if name)
    if options.evaluated:
        results = json.loads((options.evaluated / "results.json").read_text())
        names = names or tuple(results["sequences"])
    experiment = Experiment(read_sequences(options.data, names), options.out)
    if options.evaluated:
        folders = take_over(options.evaluated, results, options.out)
        lines = compare(experiment.report([*folders.values()]), results, folders)
        print("\n".join(lines))
        return 0
    tracker = Got10kTracker(tracker_spec(options.tracker, options.models), first_pixel=1)
    with one_thread():
        experiment.run(tracker)
    overall = experiment.report([tracker.name])[tracker.name]["overall"]
    print(
        f"{tracker.name}: AUC {overall['success_score']:.4f}, P20 "
        f"{overall['precision_score']:.4f}, {overall['speed_fps']:.0f} frames/s"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
