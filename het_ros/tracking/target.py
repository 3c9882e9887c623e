# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of one target: how a frame goes through the layers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.colour import ColourEnsemble
from het_ros.tracking.bottom.ensemble import BaseEnsemble, EnsembleFactory, Look, Plane
from het_ros.tracking.bottom.flow import FlowEnsemble
from het_ros.tracking.bottom.network import NetworkEnsemble, Proposal
from het_ros.tracking.bottom.sub_patches import SubPatchEnsembles, draw_layout
from het_ros.tracking.box import Box
from het_ros.tracking.calibration import Calibration
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.cost import check_cost
from het_ros.tracking.estimate import Estimate, Patch, State, lasting_deviation
from het_ros.tracking.features.extractor import FeatureExtractor, target_cells
from het_ros.tracking.fitted import FITTED
from het_ros.tracking.middle.colour_extent import ColourExtent
from het_ros.tracking.middle.fusion import (
    Agreement,
    Disagreement,
    FusionConfig,
    followed_size,
    fused_place,
    network_is_right,
)
from het_ros.tracking.middle.size import Size
from het_ros.tracking.middle.voting import Peak, best_place, distractor, peak_near
from het_ros.tracking.top.background import Background
from het_ros.tracking.top.confidence import Confidence, Decision
from het_ros.tracking.top.ego_motion import EgoMotion
from het_ros.tracking.top.kalman import AdaptiveKalman
from het_ros.tracking.top.redetection import Redetection
from het_ros.tracking.top.velocity import VelocityFilter

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]
# Least and most weight of a sub-patch, as in the paper.
_WEIGHTS = 0.1, 0.9


@dataclass(frozen=True)
class LearningConfig:
    """When the models learn.

    Attributes:
        all: of the first frames each is learnt (chosen: a single one is a poor sample).
        every: of the others one in so many (measured: time, at no loss).
    """

    all: int = 6
    every: int = 2


@dataclass(frozen=True)
class _Found:
    """The best place of a look.

    Attributes:
        look: that it was found in.
        peak: the place, cells.
        box: the target there, image px.
        score: mean score of the sub-patches there; ``distractor`` the highest elsewhere.
        colour: likelihood of the colours there.
        weights: (Q,) of the sub-patches there.
        proposal: the network's box there, if it is followed.
        agreement: what the network says of it, if there is one.
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


@dataclass(frozen=True)
class _Votes:
    """Votes for each place of the target's corner, (rows, columns) float32.

    Attributes:
        template: mean score of the sub-patches.
        colour: likelihood of the colours.
        response: all together.
    """

    template: Plane
    colour: Plane
    response: Plane


class Target:
    """The model of one target; a new target is a new model.

    Args:
        config: parameters.
        image: (H, W, 3) or (H, W) uint8.
        box: the target in it.
        calibration: the fitted constants.
        further: base ensembles beside those of the configuration; the vote of each multiplies.

    Raises:
        ValueError: it would take more memory than ``most_memory``.
    """

    def __init__(
        self,
        config: TrackerConfig,
        image: Image,
        box: Box,
        calibration: Calibration = FITTED,
        further: Sequence[EnsembleFactory] = (),
    ) -> None:
        rng = np.random.default_rng(config.seed)
        cells = target_cells((box.w, box.h), config.working_side)
        check_cost(config, cells)
        layout = draw_layout(cells, config.sub_patches, config.sub_patch_fraction, rng)
        self._layout = layout
        self._extractor = FeatureExtractor(
            image,
            cells,
            layout.size,
            config.features,
            config.search_radius,
            config.gray_below,
            rng,
        )
        cell, gray = self._extractor.cell, self._extractor.gray
        rates = config.learning_rate, config.fast_learning_rate
        self._patches = SubPatchEnsembles(layout, cells, rates, config.ridge, config.first_frame)
        self._colour = ColourEnsemble((cells[0] * cell, cells[1] * cell), cell, config.colour_rate)
        self._flow = FlowEnsemble(cell)
        self._further = tuple(make(image, box) for make in further)
        self._ensembles: tuple[BaseEnsemble, ...] = (
            self._patches,
            self._colour,
            self._flow,
            *self._further,
        )
        # In gray images blur takes texture away as it does shape: the two must not count twice.
        self._colour_power = 0.7 if gray else 1.0
        self._config = config
        self._extent = None if config.network else ColourExtent()
        self._size = Size(
            np.array([box.w, box.h]),
            cells,
            config.scale_rate,
            config.first_frame,
            config.growth_limit,
        )
        side = math.sqrt(box.area)
        self._motion = AdaptiveKalman(
            np.array(box.centre),
            config.acceleration * side,
            config.measurement_noise * side,
            config.nominal_dt,
            config.longest_dt,
        )
        self._velocity = VelocityFilter(np.array(box.centre), side)
        self._network: NetworkEnsemble | None = None
        if config.network:
            self._network = NetworkEnsemble(Path(config.network), config.network_thread)
            self._network.start(image, box)
        self._ego_motion = EgoMotion(image)
        self._background = Background(image.shape, side) if config.background else None
        self._redetection = Redetection()
        self._confidence = Confidence(config.lost_after, calibration)
        self._fusion = FusionConfig.of(calibration)
        self._last_seen = np.array(box.centre)
        self._score = 1.0
        self._judged = box
        self._disagreement: Disagreement | None = None
        self._frames = 0
        self._learn(self._look(image, np.array(box.centre)), box, 1.0, 1.0)

    @property
    def confidence(self) -> Confidence:
        """What judges the target; its ``features`` are those of the last frame."""
        return self._confidence

    @property
    def judged(self) -> Box:
        """The box whose place was judged in the last frame, whether or not it was followed."""
        return self._judged

    @property
    def disagreement(self) -> Disagreement | None:
        """Of network and ensembles in the last frame; None where their places are one."""
        return self._disagreement

    def follow(
        self,
        image: Image,
        dt: float,
        witness: Callable[[Box], bool] | None = None,
        candidates: Sequence[Box] = (),
    ) -> Estimate:
        """One frame: predict, look, vote, judge, correct, learn.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            dt: time since the last frame, s.
            witness, candidates: see :meth:`HierarchicalEnsembleTracker.update`.
        """
        self._frames += 1
        step = self._motion.step(dt)
        self._motion.predict(dt)
        place = self._search_place(image, candidates)
        proposed = self._network.begin(image, place, self._size.size) if self._network else None
        self._follow_scene(image, step)
        found = self._find(image, place, proposed)
        decision = self._judge(found, image, step, witness)
        self._score = decision.score
        if not decision.follow:
            self._coast()
            return self.estimate(decision.score, decision.state)
        self._correct(found, decision)
        self._update_model(found, decision, image, step)
        return self.estimate(decision.score, decision.state, self._found_patches(found))

    def _follow_scene(self, image: Image, step: float) -> None:
        """Move what is known of the scene with the camera, and the velocity on."""
        self._velocity.predict(step, math.sqrt(float(self._size.size.prod())))
        shift = self._ego_motion.follow(image, step)
        if self._background:
            self._background.move(shift)

    def _search_place(self, image: Image, candidates: Sequence[Box]) -> Floats:
        """(x, y), image px: where the search window goes."""
        size = self._size.size
        likelihood = None
        if self._config.colour_weight:

            def likelihood(pixels: Image) -> NDArray[np.float32]:
                return self._colour.likelihood(self._extractor.in_kind(pixels))

        return self._redetection.next_place(
            self._confidence.unseen,
            self._motion.centre,
            self._box(self._last_seen),
            self._extractor.reach(size),
            image,
            likelihood,
            candidates,
        )

    def _look(self, image: Image, centre: Floats) -> Look:
        """The search window around ``centre`` (x, y), image px."""
        frame = self._extractor.look(image, centre, self._size.size)
        cells = self._extractor.cells
        places = self._layout.places(frame.features.shape[1:], cells)
        return Look(frame, image, self._motion.centre, self._size.size, cells, places, self._score)

    def _find(self, image: Image, at: Floats, proposed: Callable[[], Proposal] | None) -> _Found:
        """All base ensembles vote; the best place is the target's if anything is."""
        self._disagreement = None
        look = self._look(image, at)
        votes = self._vote(look)
        if proposed is None:
            return self._best_of(look, self._with_further(look, votes))
        proposal = proposed()
        theirs = np.array(proposal.box.centre)
        if proposal.score > self._fusion.sure and not self._shows(look, theirs):
            look = self._look(image, theirs)
            votes = self._vote(look)
        return self._fused(look, self._with_further(look, votes), proposal)

    def _vote(self, look: Look) -> _Votes:
        """The votes of our own ensembles, which may be asked more than once a frame."""
        share = self._config.colour_weight
        template, colour = self._patches.vote(look), self._colour.vote(look)
        response = (1 - share) * template + share * colour
        near = self._flow.vote(look)
        if near is not None:
            # A factor: what slides over the target moves smoothly too, but does not look like it.
            response = response * (1 + self._config.flow_weight * near)
        return _Votes(template, colour, response)

    def _with_further(self, look: Look, votes: _Votes) -> _Votes:
        """The votes with those of the ensembles that were given, which are asked once a frame."""
        response = votes.response
        for ensemble in self._further:
            gain = ensemble.vote(look)
            if gain is not None:
                response = response * (1 + gain)
        return replace(votes, response=response)

    def _best_of(self, look: Look, votes: _Votes) -> _Found:
        peak = best_place(votes.response)
        return self._at(look, votes, peak, look.centre_of(peak.corner))

    def _at(self, look: Look, votes: _Votes, peak: Peak, centre: Floats) -> _Found:
        """A target with its ``centre`` (x, y) there, image px, next to a peak of the votes."""
        row, column = peak.row, peak.column
        return _Found(
            look,
            peak,
            self._box(centre),
            float(votes.template[row, column]),
            distractor(votes.template, peak, look.cells),
            float(votes.colour[row, column]) ** self._colour_power,
            self._patches.scores_at(row, column),
        )

    def _shows(self, look: Look, centre: Floats) -> bool:
        """Whether a target with its ``centre`` there is voted for in this look."""
        column, row = look.corner_of(centre).tolist()
        return bool(0 <= row <= look.places[0] - 1 and 0 <= column <= look.places[1] - 1)

    def _fused(self, look: Look, votes: _Votes, proposal: Proposal) -> _Found:
        """The place that network and ensembles agree on, or the likelier of their two places."""
        config, side = self._fusion, math.sqrt(float(look.size.prod()))
        ours = self._best_of(look, votes)
        place, theirs = np.array(ours.box.centre), np.array(proposal.box.centre)
        apart = float(np.hypot(*(theirs - place))) / side
        if apart < config.agree:
            centre = fused_place(place, theirs)
            found = self._at(
                look, votes, peak_near(votes.template, look.corner_of(centre)), centre
            )
            return replace(found, proposal=proposal, agreement=Agreement(proposal.score, apart))
        here = proposal.score_at(place, config.near * side)
        there = peak_near(votes.response, look.corner_of(theirs))
        gained = votes.response[there.row, there.column] - votes.response.max()
        self._disagreement = Disagreement(
            proposal.score,
            here,
            float(gained),
            self._confidence.usual,
            _point(theirs),
            _point(place),
            _point(look.expected),
            side,
        )
        if network_is_right(self._disagreement, config):
            found = self._at(look, votes, there, theirs)
            agreement = Agreement(proposal.score, min(apart, 1.0))
            return replace(found, proposal=proposal, agreement=agreement)
        return replace(ours, agreement=Agreement(here, min(apart, 1.0)))

    def _judge(
        self,
        found: _Found,
        image: Image,
        dt: float,
        witness: Callable[[Box], bool] | None,
    ) -> Decision:
        """Whether it is the target, or something else that stands there."""
        self._judged = found.box
        occluded = witness is not None and not witness(found.box)
        if not occluded and self._background:
            occluded = self._background.shows(image, found.box)
        away = np.array(found.box.centre) - found.look.expected
        return self._confidence.judge(
            found.score,
            found.colour,
            found.distractor,
            float(np.hypot(*away)) / math.sqrt(found.box.area),
            float(found.weights.std()),
            occluded,
            dt,
            found.agreement,
        )

    def _coast(self) -> None:
        """The target is not there: go on as predicted."""
        self._motion.coast()
        self._velocity.coast()
        for ensemble in self._ensembles:
            ensemble.forget()

    def _correct(self, found: _Found, decision: Decision) -> None:
        """The target is in the box that was found: the motion model takes it in."""
        centre = np.array(found.box.centre)
        if decision.returned:
            self._motion.restart(centre)
            self._velocity.restart(centre, math.sqrt(found.box.area))
        else:
            self._velocity.correct(centre)
            self._motion.correct(centre, float(np.clip(found.weights, *_WEIGHTS).mean()))
        self._redetection.forget()
        self._last_seen = centre

    def _update_model(self, found: _Found, decision: Decision, image: Image, dt: float) -> None:
        """Size, base ensembles and background follow the target, as far as it is believed."""
        ratio, centre = 1.0, np.array(found.box.centre)
        if self._extent and decision.state is State.TRACKING:
            cell, cells = self._extractor.cell, np.array(self._extractor.cells)
            self._extent.follow(self._colour.seen, found.peak.corner * cell, cells * cell)
        if decision.weight:
            middle = found.look.middle_of(found.peak.corner)
            ratio = self._size.follow(found.look.frame, middle, self._flow.flow, dt)
        if found.proposal:
            before = self._size.size
            self._size.size = followed_size(before, found.proposal)
            ratio *= math.sqrt(float((self._size.size / before).prod()))
        box = self._box(centre)
        self._learn(found.look, box, ratio, decision.weight)
        if self._background and decision.state is State.TRACKING:
            self._background.remember(image, box, dt)

    def _learn(self, look: Look, box: Box, ratio: float, weight: float) -> None:
        """Learn what is there; the flow remembers every frame, the models need not."""
        config = LearningConfig()
        if self._frames > config.all and self._frames % config.every:
            weight = 0.0
        for ensemble in self._ensembles:
            ensemble.learn(look, box, weight)
        if weight:
            middle = look.frame.window.to_window(np.array(box.centre))
            self._size.learn(look.frame, middle, ratio, weight)

    def _found_patches(self, found: _Found) -> tuple[Patch, ...]:
        """The sub-patches where they were found, image px, for drawing."""
        window, size = found.look.frame.window, np.array(self._layout.size)
        width, height = (size / np.array(window.scale)).tolist()
        centres = window.to_image(found.peak.corner + self._layout.offsets + size / 2)
        weights = np.clip(found.weights, *_WEIGHTS)
        return tuple(
            Patch(Box.from_centre(x, y, width, height), weight)
            for (x, y), weight in zip(centres.tolist(), weights.tolist(), strict=True)
        )

    def _box(self, centre: Floats) -> Box:
        """The target's box around ``centre`` (x, y), px, at its present size."""
        (x, y), (width, height) = centre.tolist(), self._size.size.tolist()
        return Box.from_centre(x, y, width, height)

    def estimate(self, score: float, state: State, patches: tuple[Patch, ...] = ()) -> Estimate:
        """What the two filters of the motion hold, as an estimate."""
        box, motion = self._box(self._motion.centre), self._velocity.motion
        if self._extent:
            box = self._extent.refined(box)
        lasting = lasting_deviation(score) * np.array([box.w, box.h])
        covariance = np.zeros((4, 4))
        covariance[:2, :2] = self._motion.covariance[:2, :2] + np.diag(lasting**2)
        covariance[2:, 2:] = motion.covariance
        own_x, own_y = (np.array(motion.total) - self._ego_motion.velocity).tolist()
        return Estimate(
            box, motion.total, covariance, score, state, patches, (own_x, own_y), motion
        )


def _point(place: Floats) -> tuple[float, float]:
    x, y = place.tolist()
    return x, y
