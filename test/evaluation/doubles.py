# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Trackers and sequences whose scores are known beforehand."""

import cv2
import numpy as np

from het_ros.evaluation.answers import Answer
from het_ros.evaluation.sequences import Frames, Sequence
from het_ros.evaluation.trackers import TrackerSpec


def write_sequence(folder, boxes, image=(48, 64)):
    """Draw a textured square on gray for each box (None: nothing) and return the Sequence."""
    texture = np.random.default_rng(1).integers(0, 255, (100, 100, 3), dtype=np.uint8)
    (folder / "img").mkdir(parents=True)
    files, rows, lines = [], [], []
    for number, box in enumerate(boxes, start=1):
        canvas = np.full((*image, 3), 90, np.uint8)
        if box is not None:
            x, y, w, h = box
            canvas[y : y + h, x : x + w] = texture[:h, :w]
        file = folder / "img" / f"{number:04d}.png"
        cv2.imwrite(str(file), canvas)
        files.append(str(file))
        rows.append(box or (np.nan,) * 4)
        lines.append("NaN,NaN,NaN,NaN" if box is None else f"{x + 1},{y + 1},{w},{h}")
    (folder / "groundtruth_rect.txt").write_text("\n".join(lines) + "\n")
    return Sequence(folder.name, Frames(tuple(files)), np.array(rows, float))


class Scripted:
    """Answers from a list, whatever the images show."""

    def __init__(self, answers):
        self.answers = answers

    def init(self, image, box):
        self.row = 0

    def update(self, image, dt):
        self.row += 1
        answer = self.answers[self.row]
        return answer if isinstance(answer, Answer) else Answer(tuple(answer))


class Oracle:
    """Returns the truth from the start on; where there is none, the last box."""

    def __init__(self, truth, seed):
        self.truth = truth

    def init(self, image, box):
        distance = np.abs(self.truth - box.as_tuple()).sum(axis=1)
        self.row = int(np.nanargmin(distance))

    def update(self, image, dt):
        self.row += 1
        box = self.truth[self.row]
        return Answer(None if np.isnan(box).any() else tuple(box))


def spec(name, build, random=False):
    return TrackerSpec(name, build, fingerprint=name, random=random)
