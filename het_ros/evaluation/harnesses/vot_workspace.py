# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Lay out sequences of any layout, experiments and our trackers as a workspace of VOT's toolkit.

vot evaluate --workspace OUT het
vot analysis --workspace OUT het
"""

from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path

import cv2
import numpy as np

from het_ros.evaluation.readers import add_sequences, read_sequences
from het_ros.evaluation.sequences import Sequence
from het_ros.evaluation.trackers import split_names, tracker_spec

EXAMPLE = """\
example:
  python -m het_ros.evaluation.harnesses.vot_workspace --data ../shared/sequences --out out/vot \\
      --sequences Crossing,Skiing --trackers het,csrt
"""
# One pass, whose accuracy is the mean overlap. Restarts after failures (type supervised) are left
# out: with them version 0.9 of the toolkit stopped ("multiple objects were provided").
STACK = """\
title: One pass
experiments:
  onepass:
    type: unsupervised
    repetitions: 1
    analyses:
      - type: average_accuracy
        name: accuracy
        burnin: 0
"""


def write(sequences: list[Sequence], trackers: dict[str, list[str]], out: Path) -> None:
    """Write the workspace. Images are links to the data's.

    Args:
        sequences: what is followed.
        trackers: the arguments of ``vot_tracker`` by the name that the toolkit knows them by.
        out: the workspace's folder.
    """
    out.mkdir(parents=True, exist_ok=True)
    for sequence in sequences:
        _write_sequence(sequence, out / "sequences" / sequence.name)
    listed = "".join(f"{sequence.name}\n" for sequence in sequences)
    (out / "sequences" / "list.txt").write_text(listed)
    (out / "stack.yaml").write_text(STACK)
    (out / "config.yaml").write_text("registry: [./trackers.ini]\nstack: ./stack.yaml\n")
    module = "het_ros.evaluation.harnesses.vot_tracker"
    sections = (
        f"[{name}]\nlabel = {name}\nprotocol = trax\n"
        f"command = {shlex.join([sys.executable, '-m', module, *arguments])}\n"
        for name, arguments in trackers.items()
    )
    (out / "trackers.ini").write_text("\n".join(sections))


def _write_sequence(sequence: Sequence, folder: Path) -> None:
    colour = folder / "color"
    colour.mkdir(parents=True, exist_ok=True)
    suffix = Path(sequence.frames.files[0]).suffix
    for number, file in enumerate(sequence.frames.files, start=1):
        link = colour / f"{number:08d}{suffix}"
        if not link.is_symlink():
            link.symlink_to(Path(file).resolve())
    height, width = cv2.imread(sequence.frames.files[0]).shape[:2]
    (folder / "sequence").write_text(
        f"name={sequence.name}\nfps={sequence.frames.rate:.0f}\nwidth={width}\nheight={height}\n"
        f"length={len(sequence.frames)}\nchannels.color=color/%08d{suffix}\n"
    )
    # A region of one number is no region: 0 where the target is absent.
    lines = ("0" if np.isnan(box).any() else ",".join(f"{v:.4f}" for v in box)
             for box in sequence.truth)  # fmt: skip
    (folder / "groundtruth.txt").write_text("\n".join(lines) + "\n")


def main(arguments: list[str] | None = None) -> int:
    """Write a workspace; 0 when it is there, 2 when it was asked for wrongly."""
    p = argparse.ArgumentParser(
        prog="vot_workspace",
        description=__doc__,
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_sequences(p)
    p.add_argument("--out", type=Path, required=True, help="the workspace's folder")
    p.add_argument("--trackers", default="het", help="named as for evaluate (het)")
    p.add_argument("--models", type=Path, help="folder of the networks' files")
    options = p.parse_args(arguments)
    names = tuple(name for name in options.sequences.split(",") if name)
    models = ["--models", str(options.models.resolve())] if options.models else []
    try:
        trackers = {}
        for name in split_names(options.trackers):
            label = tracker_spec(name, options.models).folder
            trackers[label] = [name, *models]
        write(read_sequences(options.data, names), trackers, options.out)
    except (ValueError, OSError) as error:
        print(f"vot_workspace: {error}", file=sys.stderr)
        return 2
    print(f"vot evaluate --workspace {options.out} {' '.join(trackers)}")
    print(f"vot analysis --workspace {options.out} {' '.join(trackers)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
