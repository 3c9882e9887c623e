# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Find the sequences of a data folder, in OTB's or VOT's layout."""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from het_ros.evaluation.annotations import align, image_number, read_boxes
from het_ros.evaluation.sequences import Frames, Sequence

_IMAGES = {".jpg", ".jpeg", ".png", ".bmp", ".ppm", ".pgm", ".tif", ".tiff"}


def read_sequences(
    data: Path, names: tuple[str, ...] = (), rates: Mapping[str, float] | None = None
) -> list[Sequence]:
    """Read the sequences of a folder, without their images.

    Layouts, decided folder by folder: OTB (``NAME/img/*.jpg`` and ``NAME/groundtruth_rect.txt``,
    or ``groundtruth_rect.1.txt``... for several targets, pixels counted from 1) and VOT
    (``NAME/groundtruth.txt`` with boxes, polygons or masks, images in ``NAME/color`` or ``NAME``,
    pixels counted from 0). ``attributes.json`` beside them may tag sequences.

    Args:
        data: the folder of sequences, or of one sequence.
        names: which to take, in this order; empty for all by name.
        rates: frames/s by sequence name; "" for the others (30 unless the data says).

    Raises:
        ValueError: the folder holds no sequence, or lacks one of ``names``, or one is broken.
    """
    if not data.is_dir():
        raise ValueError(f"{data} is not a folder: give the folder that holds the sequences")
    tags = _attributes(data)
    folders = [data, *sorted(path for path in data.iterdir() if path.is_dir())]
    listed = {path.name: path for path in folders if _truth_files(path)}
    found: dict[str, tuple[Path, Path]] = {}
    for folder in listed.values():
        truths = _truth_files(folder)
        for index, truth in enumerate(truths, start=1):
            name = (
                folder.resolve().name if len(truths) == 1 else f"{folder.resolve().name}-{index}"
            )
            found[name] = folder, truth
    if not found:
        raise ValueError(
            f"{data} holds no sequence: NAME/groundtruth_rect.txt with NAME/img (OTB) or "
            "NAME/groundtruth.txt (VOT) are looked for"
        )
    missing = [name for name in names if name not in found]
    if missing:
        raise ValueError(f"{data} has no {', '.join(missing)}; it has {', '.join(found)}")
    return [_read(name, *found[name], tags, rates or {}) for name in names or found]


def _truth_files(folder: Path) -> list[Path]:
    single = [folder / "groundtruth_rect.txt", folder / "groundtruth.txt"]
    several = sorted(folder.glob("groundtruth_rect.*.txt"), key=image_number)
    return several or [file for file in single if file.is_file()][:1]


def _read(
    name: str,
    folder: Path,
    truth_file: Path,
    tags: Mapping[str, list[str]],
    rates: Mapping[str, float],
) -> Sequence:
    otb = truth_file.name.startswith("groundtruth_rect")
    truth = read_boxes(truth_file, first_pixel=1 if otb else 0)
    absence = folder / "absence.label"  # GOT-10k: 1 where the target is absent
    if absence.is_file():
        flags = np.loadtxt(absence, ndmin=1) > 0
        truth[: len(flags)][flags[: len(truth)]] = np.nan
    files, truth = align(name, _images(folder), truth)
    rate = rates.get(name) or rates.get("") or _vot_rate(folder) or 30.0
    frames = Frames(tuple(str(file) for file in files), rate)
    return Sequence(name, frames, truth, tuple(tags.get(name, ())))


def _images(folder: Path) -> list[Path]:
    for place in (folder / "img", folder / "color", folder / "imgs", folder):
        if place.is_dir():
            files = [file for file in place.iterdir() if file.suffix.lower() in _IMAGES]
            if files:
                return sorted(files, key=lambda file: (image_number(file), file.name))
    raise ValueError(f"{folder} holds no images: they belong into {folder / 'img'}")


def _vot_rate(folder: Path) -> float | None:
    described = folder / "sequence"
    if described.is_file():
        for line in described.read_text().splitlines():
            key, _, value = line.partition("=")
            if key.strip() == "fps":
                return float(value)
    return None


def _attributes(data: Path) -> dict[str, list[str]]:
    for folder in (data, data.parent):
        file = folder / "attributes.json"
        if file.is_file():
            tags: dict[str, list[str]] = json.loads(file.read_text())
            return tags
    return {}


def add_sequences(parser: argparse.ArgumentParser, required: bool = True) -> None:
    """Add --data, the folder that is read, and --sequences, some of what is in it."""
    parser.add_argument(
        "--data", type=Path, required=required, help="folder of sequences (OTB, VOT)"
    )
    parser.add_argument("--sequences", default="", help="comma-separated (default: all)")
