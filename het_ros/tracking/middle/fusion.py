# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is made of the ensembles' place and the network's box.

Where both agree, the place is a weighted mean. Where they differ, it is the network's if that is
sure. The box's size follows the network's, its area faster than its aspect: arms and legs change
the aspect from step to step, an approach changes the area.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.network import Proposal

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
        sure: score over which the network's place is taken where the two differ, beyond the search
            window as well (chosen: a regression on scores, votes and distances of both places is
            no better on 37 sequences).
    """

    agree: float = 0.5
    network: float = 0.6
    area: float = 0.4
    aspect: float = 0.2
    sure: float = 0.5


@dataclass(frozen=True)
class Agreement:
    """What network and ensembles say of the chosen place together.

    Attributes:
        network_score: the network's probability of its own place, 0..1.
        apart: distance of their two places, target sides, at most 1.
        resemblance: of the place to the first box, -1..1, by the network's features.
    """

    network_score: float
    apart: float
    resemblance: float


def fused_place(ours: Floats, theirs: Floats) -> Floats:
    """(x, y): the place that both agree on."""
    share = FusionConfig().network
    return np.asarray(share * theirs + (1 - share) * ours)


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
