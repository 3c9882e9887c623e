# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Strips of frames: where the trackers of a comparison differ most."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence as Listing

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.drawing import Colour, Image, draw_boxes, draw_label
from het_ros.evaluation.runs import FROM_THE_START
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.summary import Scored

HEIGHT = 200  # of a frame in a strip, px
SHOWN = 5  # trackers drawn: more hide the picture


def strips(
    scored: Listing[Scored],
    sequences: Listing[Sequence],
    ranked: Listing[str],
    palette: Mapping[str, Colour],
    frames: int = 5,
) -> dict[str, bytes]:
    """A JPEG strip for each sequence, those first in which the trackers differ most.

    Drawn are the first runs (seed 0, first start) of the best trackers, and the truth.
    """
    found = []
    for sequence in sequences:
        runs = _first_runs(scored, sequence.name, ranked)
        if not runs:  # of a protocol that leaves frames out
            continue
        spread = disagreement([s.score.overlap for s in runs.values()])
        rows = spaced_peaks(spread, frames)
        found.append((float(np.nanmean(spread)), sequence, runs, rows))
    found.sort(key=lambda item: -item[0])
    return {seq.name: strip(seq, _boxes(runs), rows, palette) for _, seq, runs, rows in found}


def _boxes(runs: Mapping[str, Scored]) -> dict[str, NDArray[np.float64]]:
    return {name: s.run.track.boxes for name, s in list(runs.items())[:SHOWN]}


def _first_runs(scored: Listing[Scored], sequence: str, ranked: Listing[str]) -> dict[str, Scored]:
    runs: dict[str, Scored] = {}
    for s in scored:
        if (
            s.run.sequence == sequence
            and s.run.rows == FROM_THE_START
            and s.run.tracker not in runs
        ):
            runs[s.run.tracker] = s
    return {name: runs[name] for name in ranked if name in runs}


def disagreement(overlaps: Listing[NDArray[np.float64]]) -> NDArray[np.float64]:
    """(n,) standard deviation of the trackers' overlaps, frame by frame; 0 where none counts."""
    return np.asarray(np.nan_to_num(np.std(np.stack(overlaps), axis=0)))


def spaced_peaks(values: NDArray[np.float64], count: int) -> list[int]:
    """The ``count`` highest places that lie a tenth of the length apart, in their order."""
    gap = max(len(values) // 10, 1)
    left = values.astype(float).copy()
    chosen: list[int] = []
    while len(chosen) < count and np.isfinite(left).any():
        best = int(np.nanargmax(np.where(np.isfinite(left), left, np.nan)))
        chosen.append(best)
        left[max(best - gap + 1, 0) : best + gap] = -np.inf
    return sorted(chosen)


def strip(
    sequence: Sequence,
    boxes: Mapping[str, NDArray[np.float64]],
    rows: Listing[int],
    palette: Mapping[str, Colour],
) -> bytes:
    """A JPEG of some frames side by side, the truth and each tracker's box drawn on them.

    Args:
        sequence: gives images and truth.
        boxes: (n, 4) px by tracker.
        rows: the frames.
        palette: a colour for each tracker.
    """
    pictures: list[Image] = []
    for row in rows:
        image = sequence.frames[row]
        scale = HEIGHT / image.shape[0]
        here = {name: of[row] for name, of in boxes.items()}
        picture = draw_boxes(image, here, palette, sequence.truth[row], scale)
        draw_label(picture, f"#{row}")
        pictures.append(picture[:HEIGHT])
    width = min(picture.shape[1] for picture in pictures)
    joined = np.hstack([picture[:, :width] for picture in pictures])
    done, encoded = cv2.imencode(".jpg", joined, [cv2.IMWRITE_JPEG_QUALITY, 85])
    if not done:
        raise RuntimeError(f"the strip of {sequence.name} could not be encoded")
    return encoded.tobytes()
