# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Whether what was found is the target: what to follow, what to learn, when to give up.

The mean weight of the combination says how the sub-patches compare, not whether the target is
there. That is judged here, from raw evidence relative to what it was while all went well.
"""

from __future__ import annotations

import math
from dataclasses import replace
from enum import Enum

from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import State
from het_ros.tracking.evidence import FAR, Evidence, probability, recognised

_RUNNING_RATE = 0.05  # of the means of the evidence, a frame
_LONGEST_DOUBT = 0.5  # s; who is doubted for longer is not followed any more
_RETURN_COLOUR = 0.6  # share of the colours' mean below which nobody comes back
_TWIN_TEMPLATE = 0.75  # share of the score's mean that makes a rival a twin
_TWIN_TIME = 1.2  # s in which it may be either: after a twin, or a return far off
_AWAY = 5  # frames hidden, from which on it is a return when somebody is seen again
_RETURN_FAR = 0.85  # one far off must be recognised with this probability, ...
_RETURN_RESIZED = 0.9  # one at another size with this, ...
_WHOLE = 0.8  # ... and at least this share of the score's mean
_UNSURE = 0.85  # probability of being recognised below which a return is on probation, ...
_PROBATION = 1.0  # ... s in which only who ...
_AS_BEFORE = 0.85  # ... is this much like the target (share of the score's mean) is learnt
_ANY_RIVAL = 10.0  # shares beyond this say no more
_YOUNG = 10  # frames in which the model has seen too little to be ambiguous about a rival
_NEVER_BELOW = 0.2  # relative template score that nothing can excuse
_LIKELY = 0.75  # least score of a place that is clearly the target's, ...
_CLEAR = 0.6  # ... and the most that the best other place has of its template score
_BARELY = 0.65  # share of ``hidden`` below which not even such a place is followed
_IN_PLACE = 0.3  # target sides from the prediction: who is found there ...
_KNOWN_THERE = 0.8  # ... and recognised with this probability is not hidden, ...
_BARELY_THERE = 0.4  # ... down to this share of ``hidden``, ...
_UNCLEAR_TIME = 0.5  # ... unless nothing else has spoken for it for so long, s
_SAME = 0.5  # likeness to the first frame that nothing else has near the target


class Verdict(Enum):
    """What a frame's measurement is good for."""

    SEEN = "seen"  # follow it and learn from it
    DOUBTED = "doubted"  # follow it with reserve, learn nothing
    HIDDEN = "hidden"  # the target is not there


class Trust:
    """Judges each frame and keeps the state TRACKING, COASTING or LOST.

    Args:
        limits: the configuration, of which the thresholds are taken.

    Attributes:
        state: TRACKING, COASTING or LOST.
        score: probability that the last frame's box is right, 0..1.
        hidden_frames, hidden_for: frames, and s, since the target was last seen.
    """

    def __init__(self, limits: TrackerConfig) -> None:
        self._limits = limits
        self._template = 1.0
        self._colour: float | None = None
        self._frames = 0
        self._doubted_for = 0.0
        self._unclear_for = 0.0
        self._since_twin = math.inf
        self._since_return = math.inf
        self.hidden_frames = 0
        self.hidden_for = 0.0
        self.state = State.TRACKING
        self.score = 1.0

    def judge(self, evidence: Evidence, dt: float, witnessed: bool = True) -> Verdict:
        """Judge one frame; sets ``state`` and ``score``.

        Args:
            evidence: of the best place of this frame.
            dt: time since the last frame, s.
            witnessed: False where another sensor sees something else there, or what is there
                stood there before the target came.
        """
        self._frames += 1
        if self._colour is None:
            self._colour = evidence.colour
        relative = self._relative(evidence)
        verdict = Verdict.HIDDEN
        if witnessed and (self.state is State.TRACKING or self._is_back(relative)):
            verdict = self._verdict(relative)
        self._doubted_for = self._doubted_for + dt if verdict is Verdict.DOUBTED else 0.0
        plain = verdict is not Verdict.HIDDEN and self._is_plain(relative)
        self._unclear_for = 0.0 if plain else self._unclear_for + dt
        if self._doubted_for > _LONGEST_DOUBT:
            # Light that changed for good is learnt; what covers the target is not followed.
            sure = self._is_clear(relative) or _is_same(relative)
            verdict = Verdict.SEEN if sure else Verdict.HIDDEN
        self.score = self._rate(relative, dt)
        if verdict is Verdict.HIDDEN:
            self.hidden_for += dt
            self.hidden_frames += 1
            lost = self.hidden_for > self._limits.lost_after or self.state is State.LOST
            self.state = State.LOST if lost else State.COASTING
            self.score = 0.0 if lost else min(self.score, 0.5)
            return verdict
        elsewhere = self.hidden_frames >= _AWAY and relative.moved > FAR
        if elsewhere:
            # Who looks the same may have come out there: time will tell.
            self._since_twin = 0.0
        if elsewhere or self._is_stranger(relative):
            self.score = min(self.score, 0.5)
        unsure = self._returns_unsure(relative)
        self._since_return = 0.0 if unsure else self._since_return + dt
        self.hidden_for = 0.0
        self.hidden_frames = 0
        self.state = State.TRACKING
        if verdict is Verdict.SEEN:
            self._template += _RUNNING_RATE * (evidence.template - self._template)
            self._colour += _RUNNING_RATE * (evidence.colour - self._colour)
        return verdict

    def is_surely_back(self, evidence: Evidence, other: Evidence) -> bool:
        """Whether a hidden target has come back at another size.

        Args:
            evidence: of the best place at that size.
            other: of the best place at the size that is known, which must say less.
        """
        relative = self._relative(evidence)
        probability = recognised(relative)
        least = max(_RETURN_RESIZED, recognised(self._relative(other)))
        # Half of a target looks much like all of it at a smaller size.
        whole = relative.template >= _WHOLE
        return whole and probability > least and self._is_back(relative)

    def _relative(self, evidence: Evidence) -> Evidence:
        """Template and colour over their means, the rival over the best place."""
        template = evidence.template / self._template
        # Without a colour model the colours neither speak for a place nor against it.
        colour = evidence.colour / self._colour if self._colour else 1.0
        rival = min(max(evidence.rival, 0.0) / max(evidence.template, 1e-6), _ANY_RIVAL)
        return replace(evidence, template=template, colour=colour, rival=rival)

    def _score(self, relative: Evidence) -> float:
        """Probability that this frame's box is right."""
        template = relative.template * self._template
        return probability(template, self._template, relative.colour, relative.rival)

    def _is_clear(self, relative: Evidence) -> bool:
        """Whether it is likely the target and no other place looks nearly as good."""
        return relative.rival <= _CLEAR and self._score(relative) >= _LIKELY

    def _is_plain(self, relative: Evidence) -> bool:
        """Whether shape and colours speak for it, or it is clearly the likeliest place."""
        alike = relative.alike >= self._limits.hidden
        return (alike and relative.colour >= _RETURN_COLOUR) or self._is_clear(relative)

    def _is_in_place(self, relative: Evidence) -> bool:
        """Whether it is where it must be and known there, though blur or light take much away."""
        barely = relative.alike >= _BARELY_THERE * self._limits.hidden
        here = relative.moved <= _IN_PLACE and self._unclear_for <= _UNCLEAR_TIME
        known = recognised(relative) >= _KNOWN_THERE or self._is_clear(relative)
        return barely and here and known

    def _is_known_here(self, relative: Evidence) -> bool:
        """Whether it is the target near where it must be, however little of it is left."""
        return self._is_in_place(relative) or _is_same(relative)

    def _rate(self, relative: Evidence, dt: float) -> float:
        """The score of a frame; beside a twin, and for a while after it, nobody is sure."""
        score = self._score(relative)
        twin = relative.rival > self._limits.twin
        twin = twin and relative.rival * relative.template > _TWIN_TEMPLATE
        self._since_twin = 0.0 if twin else self._since_twin + dt
        return min(score, 0.5) if self._since_twin < _TWIN_TIME else score

    def _is_back(self, relative: Evidence) -> bool:
        """Whether a hidden target has come back; farther off only on stronger evidence."""
        limits = self._limits
        if self._is_known_here(relative):
            return True
        least = limits.return_probability
        if relative.moved > FAR:
            least = max(least, _RETURN_FAR)
        alike = relative.alike >= limits.hidden
        return alike and relative.colour >= _RETURN_COLOUR and recognised(relative) >= least

    def _returns_unsure(self, relative: Evidence) -> bool:
        """Whether this is a return of somebody who is not recognised for sure."""
        return self.hidden_frames >= _AWAY and recognised(relative) < _UNSURE

    def _is_stranger(self, relative: Evidence) -> bool:
        """Whether who is back may be the post that hid the target: it is not as before."""
        probation = self._returns_unsure(relative) or self._since_return < _PROBATION
        return probation and relative.template < _AS_BEFORE

    def _verdict(self, relative: Evidence) -> Verdict:
        """The rules."""
        limits = self._limits
        template, colour, rival = relative.template, relative.colour, relative.rival
        old = self._frames > _YOUNG
        if template < _NEVER_BELOW:
            return Verdict.HIDDEN
        if old and relative.alike < limits.hidden:
            # Where the light changes the colours do too, but nothing else looks like the target.
            clear = relative.alike >= _BARELY * limits.hidden and self._is_clear(relative)
            there = clear or self._is_known_here(relative)
            return Verdict.DOUBTED if there else Verdict.HIDDEN
        ambiguous = template < limits.doubt_template and rival > limits.doubt_rival
        # A post that comes in from the side takes the colours away first.
        covered = colour < limits.learn_colour and template < 1
        # Somebody who looks the same is next to the target: it may be either.
        twin = rival > limits.twin
        doubted = ambiguous or covered or twin or self._is_stranger(relative)
        return Verdict.DOUBTED if old and doubted else Verdict.SEEN


def _is_same(relative: Evidence) -> bool:
    """Whether it is not far off and looks as the target did in its first frame."""
    return (relative.likeness or 0.0) >= _SAME and relative.moved <= FAR
