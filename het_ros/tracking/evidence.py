# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What speaks for a place, and how probable that makes it the target's."""

from __future__ import annotations

import math
from dataclasses import dataclass

FAR = 0.7  # target sides: who is found farther from where he was expected may be anybody
_LARGEST = 100.0  # a logit beyond which nothing changes but that exp() overflows
# Logistic regression of "IoU over 0.5" on the evidence, over the frames of many real tracks.
_BIAS, _BY_TEMPLATE, _BY_MEAN, _BY_COLOUR, _BY_RIVAL = -8.1, 4.0, 9.2, 1.0, -2.7
# The same of "this is the hidden target", on its evidence as in :func:`recognised`.
_KNOWN = (1.0, 4.0, 2.37, -3.72, -2.0, -1.0, -4.92)
# Likeness to the first frame speaks for it from _HALF_LIKE on and below that against it, but less:
# a target may have turned for good.
_BY_LIKENESS, _LEAST_LIKE, _HALF_LIKE, _MOST_LIKE = 8.0, 0.2, 0.28, 0.6


@dataclass(frozen=True)
class Evidence:
    """What speaks for the place that was found.

    Attributes:
        template: mean score of the base ensembles there, about 1 for the target as learnt.
        colour: the colours' likelihood there, 0..1.
        rival: highest mean score of the base ensembles elsewhere in the window.
        moved: distance from the prediction, target sides.
        away: distance from where the target was last seen, target sides.
        spread: deviation of the sub-patches' weights there: of a target they agree.
        likeness: correlation with the target of the first frame, -1..1, where that is known.
    """

    template: float
    colour: float
    rival: float
    moved: float = 0.0
    away: float = 0.0
    spread: float = 0.0
    likeness: float | None = None

    @property
    def alike(self) -> float:
        """Shape and colours together."""
        return self.template * self.colour


def probability(template: float, mean: float, colour: float, rival: float) -> float:
    """Probability that a box is right (IoU over 0.5), 0..1.

    Args:
        template: mean score of the base ensembles there.
        mean: what that was on average while all went well; low for a target hard to tell.
        colour: the colours' likelihood relative to its mean.
        rival: best score elsewhere over the one there.
    """
    logit = (
        _BIAS
        + _BY_TEMPLATE * template
        + _BY_MEAN * mean
        + _BY_COLOUR * min(colour, 1.2)
        + _BY_RIVAL * min(max(rival, 0.0), 1.5)
    )
    return _logistic(logit)


def recognised(relative: Evidence) -> float:
    """Probability that what was found is the target that was hidden, 0..1.

    Args:
        relative: evidence, template and colour over their means, rival over the best.
    """
    bias, by_template, by_colour, by_rival, by_moved, by_away, by_spread = _KNOWN
    logit = (
        bias
        + by_template * relative.template
        + by_colour * min(relative.colour, 1.2)
        + by_rival * min(relative.rival, 1.5)
        + by_moved * min(relative.moved, FAR)
        + by_away * min(relative.away, FAR)
        + by_spread * relative.spread
    )
    if relative.likeness is not None:
        likeness = min(max(relative.likeness, _LEAST_LIKE), _MOST_LIKE)
        logit += _BY_LIKENESS * (likeness - _HALF_LIKE)
    return _logistic(logit)


def _logistic(logit: float) -> float:
    return 1 / (1 + math.exp(-max(logit, -_LARGEST)))
