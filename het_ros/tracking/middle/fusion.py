# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is made of the ensembles' place and the network's box.

Where both agree, the place is a weighted mean. Where they differ, one of the two is chosen, by
what each of them says of both places. The box's size follows the network's, its area faster than
its aspect: arms and legs change the aspect from step to step, an approach changes the area.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.network import Proposal
from het_ros.tracking.calibration import Calibration
from het_ros.tracking.fitted import FITTED

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class FusionConfig:
    """Constants of the fusion.

    Attributes:
        agree: distance of the two places, target sides, below which they are one (geometry: boxes
            so far apart overlap by a third).
        network: weight of the network's place in the mean (of 0.5, 0.6, 0.7 and 0.85 on 37
            sequences; between the first three there is no difference).
        area, aspect: part of the network's change of size that is taken over a frame, for a score
            of 1 (of five pairs on 37 sequences).
        sure: score from which on a place beyond the search window is looked at (chosen).
        near: radius, target sides, in which the network's score for a place is taken (geometry).
        by_score, by_votes, by_distance, bias: logistic regression of "the network's place is the
            right one" on what the network and the votes give its place more than the other, and on
            how much farther it lies from the prediction (fitted by ``make fit``).
        farthest: distance from the prediction beyond which farther is no worse, target sides
            (chosen).
    """

    agree: float = 0.5
    network: float = 0.6
    area: float = 0.4
    aspect: float = 0.2
    sure: float = 0.5
    near: float = 0.3
    by_score: float = FITTED.network_is_right[0]
    by_votes: float = FITTED.network_is_right[1]
    by_distance: float = FITTED.network_is_right[2]
    bias: float = FITTED.network_is_right[3]
    farthest: float = 1.5

    @classmethod
    def of(cls, calibration: Calibration) -> FusionConfig:
        """With the fitted constants of a calibration."""
        by_score, by_votes, by_distance, bias = calibration.network_is_right
        return cls(by_score=by_score, by_votes=by_votes, by_distance=by_distance, bias=bias)


@dataclass(frozen=True)
class Agreement:
    """What network and ensembles say of the chosen place together.

    Attributes:
        network_score: the network's probability there, 0..1.
        apart: distance of their two places, target sides, at most 1.
        resemblance: of the place to the first box, -1..1, by the network's features.
    """

    network_score: float
    apart: float
    resemblance: float


@dataclass(frozen=True)
class Disagreement:
    """What is known of two places that are too far apart to be one.

    Attributes:
        score_theirs, score_ours: the network's score of either place, 0..1.
        votes: the ensembles' vote for the network's place less that for their own.
        usual: the usual score of the sub-patches, over which votes are taken.
        theirs, ours: (x, y), px: the network's place and the ensembles'.
        expected: (x, y), px, by the motion model.
        side: of the target, px.
    """

    score_theirs: float
    score_ours: float
    votes: float
    usual: float
    theirs: tuple[float, float]
    ours: tuple[float, float]
    expected: tuple[float, float]
    side: float

    def evidence(self, farthest: float) -> tuple[float, float, float]:
        """What speaks for the network's place: scores, votes, distances; each less the other's.

        Args:
            farthest: the most that a distance from the prediction counts, target sides.
        """
        theirs, ours = (
            min(math.dist(place, self.expected) / self.side, farthest)
            for place in (self.theirs, self.ours)
        )
        return self.score_theirs - self.score_ours, self.votes / self.usual, theirs - ours


def fused_place(ours: Floats, theirs: Floats) -> Floats:
    """(x, y): the place that both agree on."""
    share = FusionConfig().network
    return np.asarray(share * theirs + (1 - share) * ours)


def network_is_right(differ: Disagreement, config: FusionConfig) -> bool:
    """Whether the network's place is the right one of the two."""
    scores, votes, distances = differ.evidence(config.farthest)
    logit = config.by_score * scores + config.by_votes * votes + config.by_distance * distances
    return logit + config.bias > 0


def followed_size(size: Floats, proposal: Proposal) -> Floats:
    """(w, h), px: the size drawn to that of the network's box.

    Args:
        size: (w, h), px, as it is.
        proposal: whose box counts by its score and by how little it changes the size.
    """
    config, box = FusionConfig(), proposal.box
    change = np.log(np.array([box.w, box.h]) / size) * proposal.score * proposal.steady
    area = config.area * change.mean()
    aspect = config.aspect * (change[0] - change[1]) / 2
    return np.asarray(size * np.exp([area + aspect, area - aspect]))
