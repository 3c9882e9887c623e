# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a target looks like: bottom and middle layer, how it is found in a window and learnt."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking import combination
from het_ros.tracking.base_ensembles import detect, scores_at
from het_ros.tracking.centring import Centring
from het_ros.tracking.colour import box_means, cell_means
from het_ros.tracking.compressive import Features
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.evidence import Evidence
from het_ros.tracking.first_look import Correction, FirstLook
from het_ros.tracking.flow_prior import FlowPrior
from het_ros.tracking.frame import Floats, Frame, Measurement
from het_ros.tracking.layers import Cells, base_ensembles, colour_model, whole
from het_ros.tracking.response import find_peak
from het_ros.tracking.sub_patches import SubPatches, to_be_updated
from het_ros.tracking.template import Template, TemplateWriter
from het_ros.tracking.view import View
from het_ros.tracking.window import Window

# A rival is a place of the target at least this part of its side away from the best one.
_RIVAL_APART = 0.35
# Blur takes texture away as it does shape: without colour the two must not count twice.
_GRAY_POWER = 0.7


class Appearance:
    """The base ensembles and the colours of one target.

    Args:
        config: parameters.
        cells: (w, h) of the target in cells.
        sub_patches: their layout.
        view: how the target is looked at.

    Attributes:
        colour: the colour histograms.
        flow: what optical flow adds to the votes.
    """

    def __init__(
        self, config: TrackerConfig, cells: Cells, sub_patches: SubPatches, view: View
    ) -> None:
        self._config = config
        self._cells = cells
        self._half = np.array(cells) / 2
        self._radius = config.search_radius / config.cell
        self._sub_patches = sub_patches
        self._view = view
        self._ensembles = base_ensembles(config, cells)
        self.colour = colour_model(config, cells)
        self.flow = FlowPrior(config, cells)
        centring = config.centring and config.colour_weight and config.trust
        self._centring = Centring(cells) if centring else None
        self._first_look: FirstLook | None = None
        self._writer: TemplateWriter | None = None

    def find(self, frame: Frame, expected: Floats, seen_at: Floats, side: float) -> Measurement:
        """Where the target is in a frame.

        Args:
            frame: a look at the image.
            expected: (x, y) of the target by the motion model, image px.
            seen_at: (x, y) where it was last seen, image px.
            side: sqrt(w h) of the target at the frame's growth, image px.
        """
        scores = self._ensembles.score_maps(frame.features)
        if self._config.combination == "weighted":
            return self._weighted(frame, scores, expected)
        colour, likelihood = self._colour_votes(frame, scores)
        middle = self._half + self._offset
        prior = self.flow.over(frame.window, expected, colour.shape, middle)
        offsets = self._sub_patches.offsets.astype(np.intp)
        apart_x, apart_y = (max(2, round(_RIVAL_APART * cells)) for cells in self._cells)
        apart = (apart_x, apart_y)
        peak = find_peak(scores, offsets, colour, self._config.colour_weight, apart, prior)
        omega = np.clip(peak.patch_scores, self._config.weight_low, self._config.weight_high)
        drawn = self._correction(frame, peak.corner)
        corner = peak.corner + drawn.shift
        centre = self.centre_in(frame.window, corner)
        moved, away = (float(np.hypot(*(centre - place))) / side for place in (expected, seen_at))
        colours = peak.colour**_GRAY_POWER if self._view.gray else peak.colour
        evidence = Evidence(
            peak.template, colours, peak.rival, moved, away, float(omega.std()), drawn.likeness
        )
        corners = self._sub_patches.corners(corner)
        return Measurement(corner, corners, omega, evidence, scores, likelihood, drawn.ratio)

    def _correction(self, frame: Frame, corner: Floats) -> Correction:
        """What the first frame says of a target at the layout's ``corner``, cells."""
        if self._first_look is None:
            return Correction(np.zeros(2), 1.0, None)
        return self._first_look.correction(frame.planes, self.middle_of(corner))

    def _weighted(self, frame: Frame, scores: Features, expected: Floats) -> Measurement:
        """The paper's middle layer: one hypothesis a sub-patch, weighted by its score."""
        config = self._config
        corners = self._sub_patches.corners(self.corner_in(frame.window, expected))
        found = detect(scores, corners, self._radius)
        omega = combination.weights(found.scores, config.weight_low, config.weight_high)
        candidates = combination.hypotheses(found.corners, self._sub_patches.offsets)
        corner = combination.combine(candidates, omega)
        return Measurement(corner, found.corners, omega, None, scores)

    def _colour_votes(
        self, frame: Frame, scores: Features
    ) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        """Of the colours for every place of the target, and their likelihood in cells."""
        config = self._config
        patch_columns, patch_rows = self._sub_patches.size
        rows = scores.shape[1] - (round(self._cells[1]) - patch_rows)
        columns = scores.shape[2] - (round(self._cells[0]) - patch_columns)
        if not config.colour_weight:
            return np.zeros((rows, columns), np.float32), None
        likelihood = cell_means(self.colour.likelihood(frame.window.pixels), config.cell)
        x, y = self._offset.tolist()
        votes = box_means(likelihood, whole(self._cells), (rows, columns), (x, y))
        return votes, likelihood

    def score_at(
        self, frame: Frame, found: Measurement, corner: Floats
    ) -> tuple[float, NDArray[np.bool_]]:
        """The base ensembles' score of a target at ``corner``, 0..1, and whom to update there."""
        corners = self._sub_patches.corners(corner)
        score = self._ensembles.likelihood(frame.features, corners)
        return score, to_be_updated(scores_at(found.scores, corners))

    def learn(self, frame: Frame, corner: Floats, chosen: NDArray[np.bool_]) -> None:
        """Re-extract the ``chosen`` (Q,) sub-patches at ``corner``, cells, and learn them."""
        self._ensembles.learn(frame.features, self._sub_patches.corners(corner), chosen)
        if self._config.colour_weight:
            x, y = (corner + self._offset) * self._config.cell
            self.colour.learn(frame.window.pixels, (float(x), float(y)))
        if self._config.first_look and self._first_look is None:
            self._first_look = FirstLook(frame.planes, self.middle_of(corner), self._cells)

    def centre(self, found: Measurement) -> None:
        """Let a box that lies beside its target move onto it."""
        if self._centring and found.likelihood is not None:
            self._centring.observe(found.likelihood, self.centre_of(found.corner))

    def template(self, frame: Frame) -> Template | None:
        """The votes as one template, of base ensembles that have one."""
        votes = self._ensembles.votes
        if votes is None:
            return None
        if self._writer is None:
            features, planes = self._view.features, len(frame.planes)
            self._writer = TemplateWriter(features, self._sub_patches, planes, self._cells)
        return self._writer.write(votes)

    @property
    def _offset(self) -> Floats:
        """(x, y), cells, of the target's centre from that of the sub-patches' layout."""
        return self._centring.offset if self._centring else np.zeros(2)

    def middle_of(self, corner: Floats) -> Floats:
        """The middle of the sub-patches' layout with its corner there, cells."""
        return np.asarray(corner + self._half)

    def centre_of(self, corner: Floats) -> Floats:
        """The centre of a target with the layout's corner there, cells."""
        return self.middle_of(corner) + self._offset

    def centre_in(self, window: Window, corner: Floats) -> Floats:
        """The same, image px."""
        return window.to_image(self.centre_of(corner))

    def corner_in(self, window: Window, centre: Floats) -> Floats:
        """The layout's corner of a target with its ``centre`` there, image px; in cells."""
        return np.asarray(window.to_window(centre) - self._half - self._offset)
