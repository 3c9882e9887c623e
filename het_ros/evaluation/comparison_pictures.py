# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the sequences on which a change loses most: the truth and both boxes."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation import raw_boxes
from het_ros.evaluation.comparison import Comparison, Side
from het_ros.evaluation.drawing import Colour, colours
from het_ros.evaluation.metrics import overlaps
from het_ros.evaluation.readers import read_sequences
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.strips import spaced_peaks, strip

WORST = 6  # sequences that are shown
FRAMES = 5  # of each
PALETTE: dict[str, Colour] = colours(["B", "A"])  # B red, A blue


def pictures(found: Comparison, data: Path, out: Path) -> Iterable[Path]:
    """Write ``out/SEQUENCE.jpg`` for the sequences on which B loses most, worst first.

    Of each sequence the seed with the largest loss is drawn, in the frames where the overlap
    falls most from A to B.

    Raises:
        ValueError: ``data`` lacks a sequence, or the raw boxes of a side are not there.
    """
    out.mkdir(parents=True, exist_ok=True)
    lost_on = [name for name in found.worst_first() if found.differences["auc"][name] < 0]
    for name in lost_on[:WORST]:
        (sequence,) = read_sequences(data, (name,))
        boxes, lost = _worst_seed(found, sequence)
        file = out / f"{name}.jpg"
        rows = spaced_peaks(lost, FRAMES)
        file.write_bytes(strip(sequence, boxes, rows, PALETTE))
        yield file


def _worst_seed(
    found: Comparison, sequence: Sequence
) -> tuple[dict[str, NDArray[np.float64]], NDArray[np.float64]]:
    """Both sides' boxes of the seed with the largest loss, and the loss of overlap by frame."""
    a, b = _seeds(found.a, sequence), _seeds(found.b, sequence)
    # A side that is not random has one run, which stands beside every seed of the other.
    pairs = [(a[min(k, len(a) - 1)], b[min(k, len(b) - 1)]) for k in range(max(len(a), len(b)))]
    losses = [np.nan_to_num(_overlap(x, sequence) - _overlap(y, sequence)) for x, y in pairs]
    worst = int(np.argmax([loss.mean() for loss in losses]))
    return {"B": pairs[worst][1], "A": pairs[worst][0]}, losses[worst]


def _seeds(side: Side, sequence: Sequence) -> list[NDArray[np.float64]]:
    folder = side.folder / "boxes" / side.tracker_folder
    files = [folder / f"{sequence.name}_{seed}.txt" for seed in range(side.figures["seeds"])]
    missing = [file for file in files if not file.is_file()]
    if missing:
        raise ValueError(f"{missing[0]} is not there: the boxes of that run are needed to draw")
    boxes = [raw_boxes.read(file) for file in files]
    if any(len(of) != len(sequence.frames) for of in boxes):
        raise ValueError(f"{folder} holds boxes of other frames than {sequence.name} has here")
    return boxes


def _overlap(boxes: NDArray[np.float64], sequence: Sequence) -> NDArray[np.float64]:
    return overlaps(boxes, sequence.truth)
