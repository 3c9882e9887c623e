# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Real frames, from $HET_SEQUENCES or from the folder beside the checkout."""

import os
from pathlib import Path

import cv2
import numpy as np
import pytest

from het_ros import Box

ROOT = Path(os.environ.get("HET_SEQUENCES", Path(__file__).parents[3] / "shared/sequences"))


class Sequence:
    """One sequence in OTB layout: its images when asked for, its boxes in px from 0."""

    def __init__(self, folder):
        self.files = sorted((folder / "img").glob("*.jpg"))
        lines = (folder / "groundtruth_rect.txt").read_text().split("\n")
        values = [[float(v) for v in line.replace(",", " ").split()] for line in lines if line]
        self.boxes = [Box(x - 1, y - 1, w, h) for x, y, w, h in values]

    def image(self, index):
        return cv2.imread(str(self.files[index]))


@pytest.fixture(scope="session")
def sequence():
    """Give the sequence of a name, or skip where there is none."""

    def load(name):
        if not (ROOT / name / "img").is_dir():
            pytest.skip(f"no sequence {name} in {ROOT}: set HET_SEQUENCES")
        return Sequence(ROOT / name)

    return load


@pytest.fixture
def noise():
    """A seeded (120, 160, 3) image of noise that is smooth enough to be followed."""
    rng = np.random.default_rng(5)
    small = rng.integers(0, 256, (30, 40, 3), dtype=np.uint8)
    return cv2.resize(small, (160, 120), interpolation=cv2.INTER_CUBIC)
