# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Groups of sequences, from ``sequence_groups.csv``, and means over them."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from collections.abc import Sequence as Listing
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

FILE = Path(__file__).with_name("sequence_groups.csv")
ALL = "all"
FIRST = "seen in development first"
LATER = "added later"
_SEEN = {"first": FIRST, "later": LATER}
_CAMERA = {"ground": "from the ground", "air": "from the air"}


@dataclass(frozen=True)
class Mean:
    """A mean over sequences.

    Attributes:
        value: the mean; each sequence counts the same.
        error: its standard error, std / sqrt(n); None for a single sequence.
        count: n, the sequences.
    """

    value: float
    error: float | None
    count: int

    def __format__(self, form: str) -> str:
        """The mean with its standard error, both in the format ``form``."""
        value = format(self.value, form)
        return value if self.error is None else f"{value} ± {format(self.error, form.lstrip('+'))}"


def mean(values: Iterable[float]) -> Mean:
    """Mean over sequences with its standard error.

    Raises:
        ValueError: there is no value.
    """
    given = np.array(list(values), float)
    if not len(given):
        raise ValueError("a mean needs at least one sequence")
    spread = np.std(given, ddof=1) / np.sqrt(len(given)) if len(given) > 1 else None
    return Mean(float(given.mean()), None if spread is None else float(spread), len(given))


@cache
def known() -> dict[str, tuple[str, ...]]:
    """The groups that each sequence of the file is in."""
    with FILE.open(newline="") as listing:
        return {
            row["sequence"]: (_SEEN[row["seen"]], row["targets"], _CAMERA[row["camera"]])
            for row in csv.DictReader(listing)
        }


def grouped(sequences: Iterable[str]) -> dict[str, list[str]]:
    """The sequences by group, ``all`` first; a group without any of them is left out.

    A sequence that the file does not name is in no group but ``all``.
    """
    names = list(sequences)
    order = [FIRST, LATER, "people", "riders", "faces", "vehicles", "animals and things"]
    found = {ALL: names} | {group: [] for group in (*order, *_CAMERA.values())}
    for name in names:
        for group in known().get(name, ()):
            found[group].append(name)
    return {group: members for group, members in found.items() if members}


def means(values: Mapping[str, float]) -> dict[str, Mean]:
    """Mean over all sequences and over each group, of one value a sequence."""
    return {g: mean(values[s] for s in members) for g, members in grouped(values).items()}


Figures = dict[str, Any]


def averaged(runs: Listing[Figures]) -> Figures:
    """Figure by figure, also in nested ones, the mean over runs of one sequence.

    A figure that is None in a run does not count there; None where no run has it.
    """
    found: Figures = {}
    for name, first in runs[0].items():
        values = [run[name] for run in runs]
        if isinstance(first, dict):
            found[name] = averaged(values)
        else:
            known = [value for value in values if value is not None]
            found[name] = float(np.mean(known)) if known else None
    return found


def over(figures: Mapping[str, Figures], *keys: str) -> Mean | None:
    """Mean over the sequences of which a figure, found by its keys, is known."""
    values = []
    for found in figures.values():
        value: Any = found
        for key in keys:
            value = value[key]
        if value is not None:
            values.append(value)
    return mean(values) if values else None
