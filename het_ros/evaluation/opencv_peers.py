# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""OpenCV's trackers behind ``init`` and ``update``, with their rough edges smoothed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from het_ros.evaluation.answers import Answer
from het_ros.tracking.box import Box

OpenCvObject = Any  # OpenCV's trackers share no class in Python
ADAPTER = 2  # count up when a change here may change results: cached ones are then run again


@dataclass(frozen=True)
class Peer:
    """Where a tracker lives in OpenCV.

    Attributes:
        factory: its function's name.
        random: whether two runs differ. OpenCV seeds these from elsewhere than its own
            generator, so a seed stands for a repetition and cannot be called back.
        whole: whether it takes boxes of whole pixels only: all of the API since OpenCV 4.5.1,
            and Boosting, whose process a box of fractions may take down.
    """

    factory: str
    random: bool
    whole: bool

    def find(self) -> Callable[[], Any] | None:
        """The function, or None when this OpenCV has no such tracker."""
        place: Any = cv2
        for part in self.factory.split("."):
            place = getattr(place, part, None)
        found: Callable[[], Any] | None = place
        return found


PEERS = {
    "csrt": Peer("TrackerCSRT_create", random=False, whole=True),
    "kcf": Peer("TrackerKCF_create", random=False, whole=True),
    "mil": Peer("TrackerMIL_create", random=True, whole=True),
    "boosting": Peer("legacy.TrackerBoosting_create", random=False, whole=True),
    "tld": Peer("legacy.TrackerTLD_create", random=True, whole=False),
    "medianflow": Peer("legacy.TrackerMedianFlow_create", random=False, whole=False),
    "mosse": Peer("legacy.TrackerMOSSE_create", random=False, whole=False),
}


def version() -> str:
    """What the peers' results depend on."""
    return f"opencv {cv2.__version__} adapter {ADAPTER}"


def available() -> list[str]:
    """The peers that this OpenCV has."""
    return [name for name, peer in PEERS.items() if peer.find()]


def require(name: str) -> None:
    """Raise ValueError, saying what to do, when this OpenCV lacks a peer."""
    if not PEERS[name].find():
        raise ValueError(
            f"{name} is not in this OpenCV ({cv2.__version__}): install "
            "opencv-contrib-python-headless in place of opencv-python-headless, as "
            "`make evaluate` does in an environment of its own"
        )


class OpenCvTracker:
    """One of OpenCV's trackers.

    OpenCV says of a frame whether the target was found; that becomes TRACKING or LOST. When it
    was not, the box of the frame before is kept, as OTB's toolkit does.
    """

    def __init__(self, name: str, seed: int) -> None:
        require(name)
        self._peer = PEERS[name]
        self._seed = seed

    def init(self, image: NDArray[np.uint8], box: Box) -> None:
        """Start on a box, rounded to whole px where the tracker takes no other."""
        cv2.setRNGSeed(self._seed)
        create = self._peer.find()
        assert create is not None
        self._tracker = create()
        sides = box.as_tuple()
        rectangle = [round(value) for value in sides] if self._peer.whole else list(sides)
        # The old API answers False, the new one None; both raise cv2.error on bad boxes.
        if self._tracker.init(np.ascontiguousarray(image), rectangle) is False:
            raise RuntimeError(f"{self._peer.factory} refused the box {rectangle}")

    def update(self, image: NDArray[np.uint8], dt: float) -> Answer:
        """Follow into the next image; ``dt`` is of no use to these."""
        found, box = self._tracker.update(image)
        if not found:
            return Answer(None, "LOST")
        x, y, w, h = (float(value) for value in box)
        return Answer((x, y, w, h), "TRACKING")


class ScoringTracker:
    """One of OpenCV's trackers that says how sure it is, 0..1.

    Where it says that the target was not found, the state is LOST and the box before is kept.
    """

    def __init__(self, create: Callable[[], OpenCvObject], seed: int = 0) -> None:
        self._create = create

    def init(self, image: NDArray[np.uint8], box: Box) -> None:
        """Start on a box, rounded to whole px."""
        self._tracker = self._create()
        self._tracker.init(np.ascontiguousarray(image), [round(v) for v in box.as_tuple()])

    def update(self, image: NDArray[np.uint8], dt: float) -> Answer:
        """Follow into the next image; ``dt`` is of no use to these."""
        found, box = self._tracker.update(image)
        score = min(max(float(self._tracker.getTrackingScore()), 0.0), 1.0)
        if not found:
            return Answer(None, "LOST", score)
        x, y, w, h = (float(value) for value in box)
        return Answer((x, y, w, h), "TRACKING", score)
