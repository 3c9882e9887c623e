# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How likely the place that was found is right, and the state that follows.

Features of the place go in; one calibrated probability that the box is right (overlap over 0.5)
comes out, by a logistic regression that ``make fit`` writes. Everything else follows from it by
three thresholds with hysteresis: what is learnt, when a target counts as hidden, when it is back.
While the probability is low but nothing else is known to stand there, the box stays on the best
place near the prediction and nothing is learnt: the target may only have changed. It coasts where
something speaks for an occluder (background, another sensor) or nothing like it is near.

A network takes anybody for a person it has lost. Where there is one, a hidden target is back only
where its colours are back, and the box does not stay on other colours that stand still.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass

from het_ros.tracking.calibration import Calibration
from het_ros.tracking.estimate import State
from het_ros.tracking.fitted import FITTED
from het_ros.tracking.middle.fusion import Agreement

LARGEST = 50.0  # a logit beyond which nothing changes but that exp() overflows; geometry


@dataclass(frozen=True)
class Features:
    """What speaks for the place that was found.

    Attributes:
        usual: exponential average of the sub-patches' mean score, about 1 for the target as
            learnt, over the frames that were learnt; low for a target that is hard to tell.
        relative: the score there over usual.
        colour: likelihood of the colours there over its own average.
        distractor: highest score elsewhere in the window over the one there.
        moved: distance from the prediction, target sides, over one more than the frames since
            the target was last recognised: the longer ago, the less a distance says.
        spread: deviation of the sub-patches' scores, which agree on a target.
    """

    usual: float
    relative: float
    colour: float
    distractor: float
    moved: float
    spread: float

    def clipped(self) -> tuple[float, ...]:
        """The features within the ranges in which more of them says more."""
        limits = (math.inf, 1.3, 1.3, 1.5, 1.0, math.inf)
        return tuple(min(max(x, 0.0), most) for x, most in zip(astuple(self), limits, strict=True))


def probability(
    features: Features, agreement: Agreement | None = None, calibration: Calibration = FITTED
) -> float:
    """Probability that the box at a place is right (overlap over 0.5), 0..1.

    Args:
        features: of the place.
        agreement: what a network says of it, where there is one.
        calibration: the weights.
    """
    known, fitted = features.clipped(), calibration.without_network
    if agreement:
        known, fitted = (*known, *astuple(agreement)), calibration.with_network
    *weights, bias = fitted
    logit = bias + sum(w * x for w, x in zip(weights, known, strict=True))
    return 1 / (1 + math.exp(-min(max(logit, -LARGEST), LARGEST)))


@dataclass(frozen=True)
class ConfidenceConfig:
    """Thresholds of the decisions, on the probability but where it says otherwise.

    Attributes:
        hidden: below this a target that was there is hidden (chosen: hysteresis to ``back``).
        back: from this on a hidden target is back (honesty: from 0.5 on the column that hides the
            walker of the recorded bag is taken for it).
        unsure: the score is at most this while the target is hidden or ambiguous (chosen: no
            confident box).
        learn_from, learn_whole: between these the learning weight rises from 0 to 1 (chosen).
        ambiguous: a distractor over this share of the score may be the target as well: nothing
            is learnt, the score is at most ``unsure`` (chosen).
        new: frames in which a target that was just given is learnt whatever is said (chosen: the
            regression is learnt from too few frames to judge).
        stay_within: distance from the prediction up to which the box stays on the best place,
            target sides (chosen: a search window is hardly wider).
        alike: with a network, similarity of the colours from which on a hidden target may be back
            (honesty: in six rendered loops with people in other clothes, without depth, this and
            the next two leave 6 of 7200 frames confident beside the target, of 618).
        stay_alike: the same, above which the box stays on the best place (honesty: what hides the
            target takes its place, but seldom its colours) ...
        moving: ... or it has a speed of its own, sides/s (chosen: a slow walk; what hides a
            target stands still in the scene).
        stay_above: relative score below which nothing like the target is there, and the
            probability falls to 0 with it (measured on
            sequences of development and others: a quarter).
        average_rate: rate of the averages (chosen: 20 frames).
    """

    hidden: float = 0.15
    back: float = 0.65
    unsure: float = 0.5
    learn_from: float = 0.4
    learn_whole: float = 0.7
    ambiguous: float = 0.9
    new: int = 10
    stay_within: float = 0.5
    alike: float = 0.75
    stay_alike: float = 0.6
    moving: float = 0.5
    stay_above: float = 0.25
    average_rate: float = 0.05


@dataclass(frozen=True)
class Observation:
    """What one frame shows at the place that was found.

    Attributes:
        score: mean score of the sub-patches there; ``distractor`` the highest elsewhere.
        colour: likelihood of the colours there, 0..1; 0 without colours.
        moved: distance from the prediction, target sides.
        spread: deviation of the sub-patches' scores there.
        speed: of the target in the scene, its sides/s.
        occluded: whether the background or another sensor says that something else is there.
        agreement: what a network says of the place, where there is one.
        similarity: with a network, of the colours there to the target's, about 1 for itself.
    """

    score: float
    distractor: float
    colour: float
    moved: float
    spread: float
    speed: float
    occluded: bool = False
    agreement: Agreement | None = None
    similarity: float | None = None


@dataclass(frozen=True)
class Decision:
    """What is done with a frame.

    Attributes:
        follow: whether the box goes to the place that was found; else it coasts.
        returned: whether the target was not followed in the last frame.
        weight: 0..1, how much of it is learnt.
        score: 0..1, published.
        state: TRACKING, COASTING or LOST.
    """

    follow: bool
    returned: bool
    weight: float
    score: float
    state: State


class Confidence:
    """Keeps averages and state of one target.

    Args:
        lost_after: s without being recognised until a target is LOST.
        calibration: weights of the probability.

    Attributes:
        features, agreement: of the last frame, for the record; None before the first.
        unseen: frames since the box was last on a place that was found.
    """

    def __init__(self, lost_after: float, calibration: Calibration = FITTED) -> None:
        self._config = ConfidenceConfig()
        self._lost_after = lost_after
        self._calibration = calibration
        self._score, self._colour = 1.0, 0.0
        self._frames = 0
        self._hidden_for = 0.0
        self._unrecognised = 0
        self._state = State.TRACKING
        self.features: Features | None = None
        self.agreement: Agreement | None = None
        self.unseen = 0

    def judge(self, seen: Observation, dt: float) -> Decision:
        """Judge one frame, ``dt`` s after the last one."""
        config = self._config
        self._frames += 1
        found = self._features_of(seen)
        self.features, self.agreement = found, seen.agreement
        likely = self._likely(found, seen.agreement)
        ambiguous = found.distractor > config.ambiguous
        if ambiguous:
            likely = min(likely, config.unsure)
        returned = self.unseen > 0
        if self._recognised(seen, found.relative, likely):
            self.unseen, self._unrecognised = 0, 0
            self._hidden_for, self._state = 0.0, State.TRACKING
            weight = 0.0 if ambiguous else self._weight(likely)
            if weight:
                self._average(seen.score, seen.colour)
            return Decision(True, returned, weight, likely, self._state)
        self._hidden_for += dt
        self._unrecognised += 1
        lost = self._state is State.LOST or self._hidden_for > self._lost_after
        self._state = State.LOST if lost else State.COASTING
        follow = not lost and self._may_be_target(seen, found.relative)
        self.unseen = 0 if follow else self.unseen + 1
        published = 0.0 if lost else min(likely, config.unsure)
        return Decision(follow, returned, 0.0, published, self._state)

    def _features_of(self, seen: Observation) -> Features:
        if not self._colour:
            self._colour = seen.colour
        return Features(
            self._score,
            seen.score / self._score,
            seen.colour / self._colour if self._colour else 1.0,
            min(max(seen.distractor, 0.0) / max(seen.score, 1e-6), 10.0),
            seen.moved / (1 + self._unrecognised),
            seen.spread,
        )

    @property
    def _young(self) -> bool:
        return self._frames <= self._config.new

    def _likely(self, features: Features, agreement: Agreement | None) -> float:
        """Probability that the box is right, bounded where the regression must not be asked."""
        config = self._config
        likely = probability(features, agreement, self._calibration)
        # The regression knows hardly any frame with nothing there: it must not extrapolate.
        if agreement is None and features.relative <= config.stay_above:
            likely *= max(features.relative, 0.0) / config.stay_above
        return max(likely, config.unsure) if self._young else likely

    def _recognised(self, seen: Observation, relative: float, likely: float) -> bool:
        """Whether it is the target: one in view may change its colours, a hidden one may not."""
        config = self._config
        least = config.hidden if self._state is State.TRACKING else config.back
        if seen.occluded or likely < least:
            return False
        nothing = seen.agreement is None and relative <= config.stay_above
        other = seen.similarity is not None and seen.similarity < config.alike
        return self._young or not (nothing or (other and self.unseen > 0))

    def _may_be_target(self, seen: Observation, relative: float) -> bool:
        """Whether what is not recognised is followed all the same: it may only have changed."""
        config = self._config
        near = seen.moved < config.stay_within and relative > config.stay_above
        other = seen.similarity is not None and seen.similarity <= config.stay_alike
        standing = other and seen.speed <= config.moving
        return near and not standing and not seen.occluded

    def _weight(self, likely: float) -> float:
        config = self._config
        part = (likely - config.learn_from) / (config.learn_whole - config.learn_from)
        return min(max(part, 0.0), 1.0)

    def _average(self, score: float, colour: float) -> None:
        rate = self._config.average_rate
        self._score += rate * (score - self._score)
        self._colour += rate * (colour - self._colour)
