# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether what was found is the target: what to follow, what to learn, when to give up.

The mean weight of the combination says how the sub-patches compare, not whether the target is
there. That is judged here, from raw evidence relative to what it was while all went well.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from het_ros.tracking.estimate import State

_RUNNING_RATE = 0.05  # of the means of the evidence, a frame
_LONGEST_DOUBT = 0.5  # s; who is doubted for longer is not followed any more
_JUST_HIDDEN = 0.2  # s
_EASY_RETURN = 0.8  # share of return_template that is enough at once or without a rival
_CLEAR_RIVAL = 0.5
_ANY_RIVAL = 10.0  # shares beyond this say no more
_YOUNG = 10  # frames in which the model has seen too little to be ambiguous about a rival
_COLOUR_POWER = 1.0
_NEVER_BELOW = 0.2  # relative template score that nothing can excuse
_SURE = 100.0  # a logit beyond which nothing changes but that exp() overflows
# Logistic regression of "IoU over 0.5" on the evidence, over the frames of many real tracks.
_BIAS, _BY_TEMPLATE, _BY_COLOUR, _BY_RIVAL = -5.0, 6.9, 2.5, -2.5


class Verdict(Enum):
    """What a frame's measurement is good for."""

    SEEN = "seen"  # follow it and learn from it
    DOUBTED = "doubted"  # follow it with reserve, learn nothing
    HIDDEN = "hidden"  # the target is not there


@dataclass(frozen=True)
class Evidence:
    """What speaks for the place that was found.

    Attributes:
        template: mean score of the base ensembles there, about 1 for the target as learnt.
        colour: the colours' likelihood there, 0..1.
        rival: highest mean score of the base ensembles elsewhere in the window.
    """

    template: float
    colour: float
    rival: float


@dataclass(frozen=True)
class TrustLimits:
    """Thresholds of the verdict; see TrackerConfig for their meaning."""

    hidden: float
    learn_colour: float
    twin: float
    doubt_template: float
    doubt_rival: float
    return_template: float
    lost_after: float


class Trust:
    """Judges each frame and keeps the state TRACKING, COASTING or LOST.

    Args:
        limits: thresholds.
    """

    def __init__(self, limits: TrustLimits) -> None:
        self._limits = limits
        self._template = 1.0
        self._colour: float | None = None
        self._frames = 0
        self._hidden_for = 0.0
        self._doubted_for = 0.0
        self.hidden_frames = 0
        self.state = State.TRACKING
        self.score = 1.0
        self.hidden_frames = 0

    def judge(self, evidence: Evidence, dt: float, witnessed: bool = True) -> Verdict:
        """Judge one frame; sets ``state`` and ``score``.

        Args:
            evidence: of the best place of this frame.
            dt: time since the last frame, s.
            witnessed: False where another sensor sees something else there.
        """
        self._frames += 1
        if self._colour is None:
            self._colour = evidence.colour
        template = evidence.template / self._template
        # Without a colour model the colours neither speak for a place nor against it.
        colour = evidence.colour / self._colour if self._colour else 1.0
        rival = min(max(evidence.rival, 0.0) / max(evidence.template, 1e-6), _ANY_RIVAL)
        verdict = self._verdict(template, colour, rival) if witnessed else Verdict.HIDDEN
        self._doubted_for = self._doubted_for + dt if verdict is Verdict.DOUBTED else 0.0
        if self._doubted_for > _LONGEST_DOUBT:
            verdict = Verdict.HIDDEN
        self.score = probability(evidence.template, colour, rival)
        if rival > self._limits.twin:
            self.score = min(self.score, 0.5)
        if verdict is Verdict.HIDDEN:
            self._hidden_for += dt
            self.hidden_frames += 1
            lost = self._hidden_for > self._limits.lost_after or self.state is State.LOST
            self.state = State.LOST if lost else State.COASTING
            self.score = 0.0 if lost else min(self.score, 0.5)
            return verdict
        self._hidden_for = 0.0
        self.hidden_frames = 0
        self.state = State.TRACKING
        if verdict is Verdict.SEEN:
            self._template += _RUNNING_RATE * (evidence.template - self._template)
            self._colour += _RUNNING_RATE * (evidence.colour - self._colour)
        return verdict

    def _verdict(self, template: float, colour: float, rival: float) -> Verdict:
        """The rules; template and colour relative to their means, rival to the peak."""
        limits = self._limits
        if self.state is not State.TRACKING:
            # One bad frame is more often the target's than a post's; and where nothing rivals
            # the place it is clear enough.
            easy = self._hidden_for < _JUST_HIDDEN or rival < _CLEAR_RIVAL
            if template < limits.return_template * (_EASY_RETURN if easy else 1):
                return Verdict.HIDDEN
        old = self._frames > _YOUNG
        if template < _NEVER_BELOW or (old and template * colour**_COLOUR_POWER < limits.hidden):
            return Verdict.HIDDEN
        ambiguous = template < limits.doubt_template and rival > limits.doubt_rival
        # A post that comes in from the side takes the colours away first.
        covered = colour < limits.learn_colour and template < 1
        # Somebody who looks the same is next to the target: it may be either.
        twin = rival > limits.twin
        return Verdict.DOUBTED if old and (ambiguous or covered or twin) else Verdict.SEEN


def probability(template: float, colour: float, rival: float) -> float:
    """Probability that a box is right (IoU over 0.5), 0..1.

    Args:
        template: mean score of the base ensembles there.
        colour: the colours' likelihood relative to its mean.
        rival: best score elsewhere over the one there.
    """
    logit = (
        _BIAS
        + _BY_TEMPLATE * template
        + _BY_COLOUR * min(colour, 1.2)
        + _BY_RIVAL * min(max(rival, 0.0), 1.5)
    )
    return 1 / (1 + math.exp(-max(logit, -_SURE)))
