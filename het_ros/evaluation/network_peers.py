# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Peers that are networks: their files in a folder, and what runs them.

The files are not part of this project; :data:`SOURCE` says where they are.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import cv2
import numpy as np

from het_ros.evaluation import nanotrack, opencv_peers
from het_ros.tracking.bottom import siamese
from het_ros.tracking.bottom.siamese import Siamese

NAMES = ("nanotrack-v2", "nanotrack-v3", "vit", "vit-corrected")
SOURCE = (
    "NanoTrack's *backbone*.onnx and *head*.onnx, each version in a folder of its own, from "
    "github.com/HonglinChu/SiamTrackers (NanoTrack/models), VitTrack's *vittrack*.onnx from "
    "github.com/opencv/opencv_zoo (models/object_tracking_vittrack)"
)
DEVIATION = (0.229, 0.224, 0.225)  # of VitTrack's training images


@cache
def found(models: Path) -> dict[str, tuple[Path, ...]]:
    """The peers whose files lie in a folder or below it, with these files.

    NanoTrack's version is told by the number of its places, VitTrack by its name.

    Raises:
        ValueError: there is no such folder, or a NanoTrack folder is not what it seems.
    """
    if not models.is_dir():
        raise ValueError(f"there is no folder of models {models}: it should hold {SOURCE}")
    peers: dict[str, tuple[Path, ...]] = {}
    for folder in sorted({file.parent for file in models.rglob("*backbone*.onnx")}):
        version = Siamese.read(folder).version
        if version:
            files = (*folder.glob("*backbone*.onnx"), *folder.glob("*head*.onnx"))
            peers.setdefault(f"nanotrack-{version}", files)
    for file in sorted(models.rglob("*vittrack*.onnx"))[:1]:
        peers |= {"vit": (file,), "vit-corrected": (file,)}
    return {name: peers[name] for name in NAMES if name in peers}


def files_of(name: str, models: Path | None) -> tuple[Path, ...]:
    """The files of one peer.

    Raises:
        ValueError: no folder is given, or it lacks them.
    """
    if models is None:
        raise ValueError(f"{name} needs a folder of models, --models FOLDER: {SOURCE}")
    if name not in found(models):
        raise ValueError(f"{models} has no network for {name}; it should hold {SOURCE}")
    return found(models)[name]


def builder(name: str, models: Path | None) -> Callable[[int], object]:
    """What makes the peer from a seed; picklable.

    Raises:
        ValueError: as :func:`files_of`; or this OpenCV has no such tracker.
    """
    files = files_of(name, models)
    if name == "nanotrack-v3":
        return partial(nanotrack.NanoTrack, files[0].parent)
    factory = "TrackerNano_create" if name == "nanotrack-v2" else "TrackerVit_create"
    if not hasattr(cv2, factory):
        raise ValueError(f"{name} is not in this OpenCV ({cv2.__version__}): install 4.9 or newer")
    create = partial(_nano if name == "nanotrack-v2" else _vit, name, files)
    return partial(opencv_peers.ScoringTracker, create)


def fingerprint(name: str, models: Path | None) -> str:
    """What the peer's results depend on: its files, OpenCV, and what is done around them here."""
    sources = (Path(module.__file__ or "") for module in (nanotrack, siamese, opencv_peers))
    digest = hashlib.sha256(f"{name} {cv2.__version__} {Path(__file__).read_text()}".encode())
    for file in (*files_of(name, models), *sources):
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def _nano(name: str, files: tuple[Path, ...]) -> opencv_peers.OpenCvObject:
    p = cv2.TrackerNano_Params()
    p.backbone, p.neckhead = (str(file) for file in files)
    return cv2.TrackerNano_create(p)


def _vit(name: str, files: tuple[Path, ...]) -> opencv_peers.OpenCvObject:
    p = cv2.TrackerVit_Params()
    p.net = str(files[0])
    if name == "vit-corrected":
        p.stdvalue = corrected_deviation()
    return cv2.TrackerVit_create(p)


def corrected_deviation() -> tuple[float, float, float, float]:
    """What makes ``cv2.TrackerVit`` divide by :data:`DEVIATION` channel by channel.

    Up to OpenCV 5.0 it divides one ``cv::Scalar`` by another, which is a quaternion's division:
    the product with the conjugate over the squared length. So the deviation has to be the
    quaternion whose inverse is r = 1 / deviation: (r0, -r1, -r2, 0) / |r|^2.
    """
    r = 1 / np.array(DEVIATION)
    a, b, c = (float(value) for value in r * (1, -1, -1) / (r**2).sum())
    return a, b, c, 0.0
