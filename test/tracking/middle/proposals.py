# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a made network proposes."""

import numpy as np

from het_ros import Box
from het_ros.tracking.bottom.network import Proposal
from het_ros.tracking.bottom.resemblance import Resemblance

SIZE = np.array([20.0, 30.0])


def proposal(size, score=1.0, steady=1.0, centre=(100.0, 50.0)):
    box = Box.from_centre(*centre, *size)
    there = np.array([0.8, 0.6], np.float32)[:, None, None]
    alike = Resemblance(np.array([1, 0], np.float32)[:, None, None], there, centre, 8.0)
    return Proposal(box, score, steady, alike)
