# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a target looks like: the base ensembles, and the place that they find it at."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.colour import ColourEnsemble
from het_ros.tracking.bottom.ensemble import BaseEnsemble, EnsembleFactory, Look, Plane
from het_ros.tracking.bottom.flow import FlowEnsemble
from het_ros.tracking.bottom.network import Proposal
from het_ros.tracking.bottom.sub_patches import SubPatchEnsembles, draw_layout
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Patch
from het_ros.tracking.features.extractor import FeatureExtractor
from het_ros.tracking.middle.fusion import Agreement, FusionConfig, fused_place
from het_ros.tracking.middle.voting import Peak, best_place, distractor, peak_near

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]
# Least and most weight of a sub-patch, as in the paper.
WEIGHTS = 0.1, 0.9
# In gray images blur takes texture away as it does shape: the two must not count twice.
GRAY_POWER = 0.7


@dataclass(frozen=True)
class Expected:
    """What is known of the target before a look.

    Attributes:
        centre: (x, y) by the motion model, image px.
        size: (w, h), image px.
        score: of the last frame, 0..1.
    """

    centre: Floats
    size: Floats
    score: float


@dataclass(frozen=True)
class Found:
    """The best place of a look.

    Attributes:
        look: that it was found in.
        peak: the place, cells.
        box: the target there, image px.
        score: mean score of the sub-patches there; ``distractor`` the highest elsewhere.
        colour: likelihood of the colours there.
        weights: (Q,) of the sub-patches there.
        proposal: the network's box there, if it is followed.
        agreement: what a network says of the place, where there is one.
        similarity: with a network, of the colours there to the target's, about 1 for itself.
    """

    look: Look
    peak: Peak
    box: Box
    score: float
    distractor: float
    colour: float
    weights: Floats
    proposal: Proposal | None = None
    agreement: Agreement | None = None
    similarity: float | None = None

    @property
    def weight(self) -> float:
        """Mean weight of the sub-patches there, which the motion model corrects by."""
        return float(np.clip(self.weights, *WEIGHTS).mean())


@dataclass(frozen=True)
class Votes:
    """Votes for each place of the target's corner, (rows, columns) float32.

    Attributes:
        template: mean score of the sub-patches.
        colour: likelihood of the colours.
        response: all together.
    """

    template: Plane
    colour: Plane
    response: Plane


class Appearance:
    """The base ensembles of one target.

    Args:
        config: parameters.
        image: (H, W, 3) or (H, W) uint8.
        box: the target in it.
        cells: (w, h) of the target, as it is looked at.
        further: base ensembles beside those of the configuration; the vote of each multiplies.

    Attributes:
        extractor: search windows and their features.
        patches, colour, flow: the tracker's own ensembles.
    """

    def __init__(
        self,
        config: TrackerConfig,
        image: Image,
        box: Box,
        cells: tuple[int, int],
        further: Sequence[EnsembleFactory] = (),
    ) -> None:
        rng = np.random.default_rng(config.seed)
        layout = draw_layout(cells, config.sub_patches, config.sub_patch_fraction, rng)
        radius, below = config.search_radius, config.gray_below
        self.extractor = FeatureExtractor(
            image, cells, layout.size, config.features, radius, below, rng
        )
        cell = self.extractor.cell
        rates = config.learning_rate, config.fast_learning_rate
        self.patches = SubPatchEnsembles(layout, cells, rates, config.ridge, config.first_frame)
        self.colour = ColourEnsemble((cells[0] * cell, cells[1] * cell), cell, config.colour_rate)
        self.flow = FlowEnsemble(cell)
        self._config = config
        self._layout = layout
        self._fusion = FusionConfig()
        self._colour_power = GRAY_POWER if self.extractor.gray else 1.0
        self._further = tuple(make(image, box) for make in further)
        self._ensembles: tuple[BaseEnsemble, ...] = (
            self.patches,
            self.colour,
            self.flow,
            *self._further,
        )

    def look(self, image: Image, at: Floats, expected: Expected) -> Look:
        """The search window around ``at`` (x, y), image px."""
        frame = self.extractor.look(image, at, expected.size)
        cells = self.extractor.cells
        places = self._layout.places(frame.features.shape[1:], cells)
        centre, size = expected.centre, expected.size
        return Look(frame, image, centre, size, cells, places, expected.score)

    def find(
        self,
        image: Image,
        at: Floats,
        expected: Expected,
        proposed: Callable[[], Proposal] | None = None,
    ) -> Found:
        """All base ensembles vote; the best place is the target's if anything is.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            at: (x, y) of the search window, image px.
            expected: what is known of the target.
            proposed: waits for the network's box, where there is a network.
        """
        look = self.look(image, at, expected)
        votes = self._vote(look)
        if proposed is None:
            return self._best_of(look, self._with_further(look, votes))
        proposal = proposed()
        theirs = np.array(proposal.box.centre)
        if proposal.score > self._fusion.sure and not _shows(look, theirs):
            look = self.look(image, theirs, expected)
            votes = self._vote(look)
        return self._fused(look, self._with_further(look, votes), proposal)

    def learn(self, look: Look, box: Box, weight: float) -> None:
        """The target is in ``box``, image px; see :meth:`BaseEnsemble.learn`."""
        for ensemble in self._ensembles:
            ensemble.learn(look, box, weight)

    def forget(self) -> None:
        """The target was not seen in this frame."""
        for ensemble in self._ensembles:
            ensemble.forget()

    def colours_of(self, pixels: Image) -> Plane:
        """How likely each pixel of an image, (H, W, 3) or (H, W) uint8, is the target's."""
        return self.colour.likelihood(self.extractor.in_kind(pixels))

    def patches_of(self, found: Found) -> tuple[Patch, ...]:
        """The sub-patches where they were found, image px, for drawing."""
        window, size = found.look.frame.window, np.array(self._layout.size)
        width, height = (size / np.array(window.scale)).tolist()
        centres = window.to_image(found.peak.corner + self._layout.offsets + size / 2)
        weights = np.clip(found.weights, *WEIGHTS)
        return tuple(
            Patch(Box.from_centre(x, y, width, height), weight)
            for (x, y), weight in zip(centres.tolist(), weights.tolist(), strict=True)
        )

    def _vote(self, look: Look) -> Votes:
        """The votes of our own ensembles, which may be asked more than once a frame."""
        share = self._config.colour_weight
        template, colour = self.patches.vote(look), self.colour.vote(look)
        response = (1 - share) * template + share * colour
        near = self.flow.vote(look)
        if near is not None:
            # A factor: what slides over the target moves smoothly too, but does not look like it.
            response = response * (1 + self._config.flow_weight * near)
        return Votes(template, colour, response)

    def _with_further(self, look: Look, votes: Votes) -> Votes:
        """The votes with those of the ensembles that were given, which are asked once a frame."""
        response = votes.response
        for ensemble in self._further:
            gain = ensemble.vote(look)
            if gain is not None:
                response = response * (1 + gain)
        return replace(votes, response=response)

    def _best_of(self, look: Look, votes: Votes) -> Found:
        peak = best_place(votes.response)
        return self._at(look, votes, peak, look.centre_of(peak.corner))

    def _at(self, look: Look, votes: Votes, peak: Peak, centre: Floats) -> Found:
        """A target with its ``centre`` (x, y) there, image px, next to a peak of the votes."""
        row, column = peak.row, peak.column
        (x, y), (width, height) = centre.tolist(), look.size.tolist()
        box = Box.from_centre(x, y, width, height)
        return Found(
            look,
            peak,
            box,
            float(votes.template[row, column]),
            distractor(votes.template, peak, look.cells),
            float(votes.colour[row, column]) ** self._colour_power,
            self.patches.scores_at(row, column),
        )

    def _fused(self, look: Look, votes: Votes, proposal: Proposal) -> Found:
        """The place that network and ensembles agree on; else the network's if it is sure."""
        config, side = self._fusion, math.sqrt(float(look.size.prod()))
        found = self._best_of(look, votes)
        place, theirs = np.array(found.box.centre), np.array(proposal.box.centre)
        apart = float(np.hypot(*(theirs - place))) / side
        agree = apart < config.agree
        if agree or proposal.score > config.sure:
            centre = fused_place(place, theirs) if agree else theirs
            peak = peak_near(votes.template if agree else votes.response, look.corner_of(centre))
            found = replace(self._at(look, votes, peak, centre), proposal=proposal)
        alike = proposal.resemblance.at(found.box.centre)
        return replace(
            found,
            agreement=Agreement(proposal.score, min(apart, 1.0), alike),
            similarity=self.colour.similarity(look, found.box),
        )


def _shows(look: Look, centre: Floats) -> bool:
    """Whether a target with its ``centre`` there is voted for in this look."""
    column, row = look.corner_of(centre).tolist()
    return bool(0 <= row <= look.places[0] - 1 and 0 <= column <= look.places[1] - 1)
