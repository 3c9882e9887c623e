# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Raw boxes as text, in the layout that the got10k and OTB toolkits read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from het_ros.evaluation.runs import Run

FIRST_PIXEL = np.array([1, 1, 0, 0])  # OTB counts pixels from 1


def write(runs: Iterable[Run], folders: Mapping[str, str], out: Path) -> None:
    """Write ``out/TRACKER/SEQUENCE_SEED.txt``: x,y,w,h a line, the top-left pixel being 1, 1.

    Seed 0 is also written as ``SEQUENCE.txt``, the name that the got10k toolkit looks for
    below ``results/OTB.../TRACKER``. Other starts than the first carry their name.
    """
    for run in runs:
        folder = out / folders[run.tracker]
        folder.mkdir(parents=True, exist_ok=True)
        start = "" if run.variant in ("ope", "restart") else f"_{run.variant}"
        text = "".join(
            ",".join(f"{value:.3f}" for value in row) + "\n"
            for row in run.track.boxes + FIRST_PIXEL
        )
        (folder / f"{run.sequence}{start}_{run.seed}.txt").write_text(text)
        if run.seed == 0 and not start:
            (folder / f"{run.sequence}.txt").write_text(text)


def read(file: Path) -> np.ndarray:
    """Read such a file back as (n, 4) boxes counted from 0."""
    return np.asarray(np.loadtxt(file, delimiter=",", ndmin=2) - FIRST_PIXEL)
