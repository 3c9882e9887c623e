# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One annotated MP4 a sequence, with every tracker's box."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from collections.abc import Sequence as Listing
from fractions import Fraction
from pathlib import Path

import numpy as np
from tqdm import tqdm

from het_ros.evaluation.drawing import Colour, Image, draw_boxes, draw_label
from het_ros.evaluation.runs import FROM_THE_START, Run
from het_ros.evaluation.sequences import Sequence

SMALL = 480  # narrower images are enlarged twice, px


def write_videos(
    runs: Listing[Run],
    sequences: Listing[Sequence],
    palette: Mapping[str, Colour],
    out: Path,
    quiet: bool = False,
) -> list[Path]:
    """Write ``out/SEQUENCE.mp4`` of each tracker's first run from the first frame."""
    out.mkdir(parents=True, exist_ok=True)
    files = []
    for sequence in tqdm(sequences, unit="video", disable=quiet):
        own: dict[str, Run] = {}
        for run in runs:
            if run.sequence == sequence.name and run.rows == FROM_THE_START:
                own.setdefault(run.tracker, run)
        file = out / f"{sequence.name}.mp4"
        encode(annotated(sequence, own, palette), sequence.frames.rate, file)
        files.append(file)
    return files


def annotated(
    sequence: Sequence, runs: Mapping[str, Run], palette: Mapping[str, Colour]
) -> Iterator[Image]:
    """The frames with boxes, a legend, and state and score of trackers that have them."""
    for row in range(len(sequence.frames)):
        image = sequence.frames[row]
        scale = 2.0 if image.shape[1] < SMALL else 1.0
        boxes = {name: run.track.boxes[row] for name, run in runs.items()}
        picture = draw_boxes(image, boxes, palette, sequence.truth[row], scale)
        draw_label(picture, f"{sequence.name} {row}")
        for line, (name, run) in enumerate(runs.items(), start=1):
            score = run.track.scores[row]
            said = f"{name} {run.track.states[row]}"
            text = f"{said} {score:.2f}" if np.isfinite(score) else said
            draw_label(picture, text, line, palette[name])
        yield picture


def encode(frames: Iterator[Image], rate: float, file: Path) -> None:
    """Encode (H, W, 3) BGR frames as H.264, cut to even sides as the codec wants.

    Raises:
        ValueError: PyAV is not installed.
    """
    try:
        import av  # an extra: only videos need it
    except ImportError:
        raise ValueError("--video needs PyAV: pip install av") from None
    with av.open(str(file), "w") as container:
        stream = None
        for picture in frames:
            height, width = (side - side % 2 for side in picture.shape[:2])
            if stream is None:
                stream = container.add_stream("h264", Fraction(rate).limit_denominator(1000))
                stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
                stream.options = {"crf": "23"}
            picture = np.ascontiguousarray(picture[:height, :width])
            frame = av.VideoFrame.from_ndarray(picture, format="bgr24")
            container.mux(stream.encode(frame))
        if stream is not None:
            container.mux(stream.encode())
