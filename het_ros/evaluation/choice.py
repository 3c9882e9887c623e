# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Which trackers a run compares, and what it leaves out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from het_ros.evaluation import network_peers, opencv_peers
from het_ros.evaluation.trackers import (
    DEFAULT,
    WITH_NETWORK,
    TrackerSpec,
    split_names,
    tracker_spec,
)


@dataclass(frozen=True)
class Choice:
    """What is compared.

    Attributes:
        trackers: the trackers.
        notes: a line for each kind that is left out: why, and what to do about it.
    """

    trackers: list[TrackerSpec]
    notes: list[str]


def chosen(text: str, models: Path | None = None) -> Choice:
    """The trackers of a comma-separated list; without one all that can run here.

    Args:
        text: names as :func:`tracker_spec` takes them, or "".
        models: folder of the networks' files, or None.

    Raises:
        ValueError: there is no such tracker or folder, or two have the same name.
    """
    if text:
        specs = [tracker_spec(name, models) for name in split_names(text)]
        if len({spec.folder for spec in specs}) < len(specs):
            raise ValueError(f"--trackers {text} names one twice: label one as label@het:...")
        return Choice(specs, [])
    present = [n for n in DEFAULT if n.startswith("het") or n in opencv_peers.available()]
    networks = network_peers.found(models) if models else {}
    notes = []
    if absent := [n for n in DEFAULT if n not in present]:
        notes.append(f"Left out, for they need opencv-contrib: {', '.join(absent)}.")
    if absent := [n for n in network_peers.NAMES if n not in networks]:
        need = f"their files are not in {models}" if models else "they need a folder, MODELS"
        notes.append(f"Left out: {', '.join(absent)}; {need}: {network_peers.SOURCE}.")
    ours = (WITH_NETWORK,) if "nanotrack-v3" in networks else ()
    names = (*present, *ours, *networks)
    return Choice([tracker_spec(name, models) for name in names], notes)
