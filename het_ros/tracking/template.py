# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""All votes of linear base ensembles as one template: a weight for each cell of each channel.

A feature is a sum of cells, a linear base ensemble a sum of features, and the vote of all
sub-patches their mean. Written out in cells, the same score can be read at any size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.compressive import CompressiveFeatures, Features
from het_ros.tracking.sub_patches import SubPatches


@dataclass(frozen=True)
class Template:
    """The mean score of the sub-patches of a target as a weighted sum of its cells.

    Attributes:
        weights: (h, C, w) float32 of the target's cells, C channels.
        constant: what is added to their sum.
    """

    weights: NDArray[np.float32]
    constant: float


class TemplateWriter:
    """Writes votes as templates.

    Args:
        features: whose maps the votes are for; they have seen a frame.
        sub_patches: that vote.
        channels: C.
        cells: (w, h) of the target.
    """

    def __init__(
        self,
        features: CompressiveFeatures,
        sub_patches: SubPatches,
        channels: int,
        cells: tuple[float, float],
    ) -> None:
        self._centre, self._scale = features.standard
        self._size = sub_patches.size
        self._offsets = sub_patches.offsets.astype(int).tolist()
        width, height = (int(np.ceil(side)) for side in cells)
        self._shape = height, channels, width
        # A row of the measurement matrix lies in one channel: by channel, its features and their
        # rectangles as cells (m_c, h w) of a sub-patch.
        self._rows = []
        wide, high = self._size
        for channel in range(channels):
            mine = [k for k, row in enumerate(features.matrix.rows) if row[0].channel == channel]
            drawn = np.zeros((len(mine), high, wide), np.float32)
            for cell_sums, feature in zip(drawn, mine, strict=True):
                for _, x0, y0, x1, y1, sign in features.matrix.rows[feature]:
                    cell_sums[y0:y1, x0:x1] += sign
            self._rows.append((mine, drawn.reshape(len(mine), high * wide)))

    def write(self, votes: Features) -> Template:
        """The template of ``votes`` (m + 1, Q), the constant's last, for standardised features."""
        weights = np.zeros(self._shape, np.float32)
        (wide, high), count = self._size, len(self._offsets)
        scaled = votes[:-1] * (self._scale / count)[:, None]  # (m, Q), of raw features
        patches = np.empty((count, high, len(self._rows), wide), np.float32)
        for channel, (mine, drawn) in enumerate(self._rows):
            written = scaled[mine].T.astype(np.float32) @ drawn
            patches[:, :, channel] = written.reshape(count, high, wide)
        for patch, (x, y) in zip(patches, self._offsets, strict=True):
            weights[y : y + high, :, x : x + wide] += patch
        constant = votes[-1].mean() - (self._centre @ scaled).sum()
        return Template(weights, float(constant))
