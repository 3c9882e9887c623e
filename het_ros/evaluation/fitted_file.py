# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The file of fitted constants, ``het_ros/tracking/fitted.py``, and the tables printed beside."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
from pathlib import Path

import numpy as np

from het_ros.evaluation.fit import Fit
from het_ros.tracking.calibration import Calibration

_FILE = '''\
# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Constants that ``make fit`` writes; not to be edited by hand.

Date: {date}.
{data}

Held out, each sequence weighing the same:
{figures}
"""

from het_ros.tracking.calibration import Calibration

FITTED = Calibration(
{fitted})

# What the tracker ran with while it was recorded.
RECORDED_WITH = Calibration(
{recorded})
'''
_DATE = re.compile(r"^Date: .*$", re.MULTILINE)


def taken_over(fits: Mapping[str, Fit], before: Calibration) -> Calibration:
    """The fitted constants; what nothing was fitted to stays."""
    return replace(before, **{name: fit.weights for name, fit in fits.items()})


def text(
    fits: Mapping[str, Fit], calibration: Calibration, recorded: Calibration, data: str, date: str
) -> str:
    """The whole file.

    Args:
        fits: for the figures.
        calibration: the constants.
        recorded: what the tracker ran with.
        data: a sentence on what was recorded.
        date: of today.
    """
    filled = textwrap.fill(data, 97, break_long_words=False, break_on_hyphens=False)
    figures = "\n".join(
        f"    {field.name}: "
        + (figures_of(fits[field.name]) if field.name in fits else "as before, not of this run")
        for field in fields(calibration)
    )
    return _FILE.format(
        date=date,
        data=filled,
        figures=figures,
        fitted=_values(calibration),
        recorded=_values(recorded),
    )


def figures_of(fit: Fit) -> str:
    """One line on what the held-out folds give."""
    found = fit.quality
    return (
        f"calibration error {found.error:.3f}, ROC {found.roc:.3f}, {len(fit.examples)} frames, "
        f"{fit.examples.right.mean():.0%} right"
    )


def _values(calibration: Calibration) -> str:
    lines = []
    for field in fields(calibration):
        values = ", ".join(repr(float(value)) for value in getattr(calibration, field.name))
        line = f"    {field.name}=({values}),\n"
        if len(line) > 100:
            inner = "".join(f"        {v},\n" for v in values.split(", "))
            line = f"    {field.name}=(\n{inner}    ),\n"
        lines.append(line)
    return "".join(lines)


def write(file: Path, content: str) -> bool:
    """Write the file; False where nothing but its date would change, and it stays."""
    if file.is_file() and _DATE.sub("", file.read_text()) == _DATE.sub("", content):
        return False
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(content)
    return True


def tables(fits: Mapping[str, Fit]) -> str:
    """Markdown: what the held-out folds give, the reliability, and each sequence."""
    lines: list[str] = []
    for name, fit in fits.items():
        lines += [f"{name}, held out: {figures_of(fit)}", ""]
        lines += ["| probability | right | weight |", "|---|---|---|"]
        lines += [f"| {p:.2f} | {r:.2f} | {w:.2f} |" for p, r, w in fit.quality.bins]
        lines += ["", *_by_sequence(fit), ""]
    return "\n".join(lines)


def _by_sequence(fit: Fit) -> Iterable[str]:
    yield "| sequence | frames | right | probability, held out |"
    yield "|---|---|---|---|"
    for name in np.unique(fit.examples.sequences):
        own = fit.examples.sequences == name
        right, said = fit.examples.right[own].mean(), fit.predicted[own].mean()
        yield f"| {name} | {own.sum()} | {right:.2f} | {said:.2f} |"


def plot(fits: Mapping[str, Fit], file: Path) -> None:
    """Draw reliability and ROC of the held-out folds, PNG."""
    from matplotlib.figure import Figure
    from sklearn.metrics import roc_curve

    figure = Figure(figsize=(8, 4), layout="constrained")
    reliability, roc = figure.subplots(1, 2)
    for name, fit in fits.items():
        said, right, _ = np.array(fit.quality.bins).T
        reliability.plot(said, right, "o-", ms=3, label=name)
        weights = fit.examples.weights
        wrong, hit, _ = roc_curve(fit.examples.right, fit.predicted, sample_weight=weights)
        roc.plot(wrong, hit, label=f"{name} {fit.quality.roc:.3f}")
    for axis, labels in ((reliability, ("probability", "share right")), (roc, ("wrong", "right"))):
        axis.plot([0, 1], [0, 1], color="gray", lw=0.5)
        axis.set(xlabel=labels[0], ylabel=labels[1], xlim=(0, 1), ylim=(0, 1))
        axis.legend(fontsize="x-small")
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=100)
