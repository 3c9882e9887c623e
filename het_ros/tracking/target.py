# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of one target: how a frame goes through the layers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.bottom.ensemble import EnsembleFactory, Look
from het_ros.tracking.bottom.network import NetworkEnsemble
from het_ros.tracking.box import Box
from het_ros.tracking.calibration import Calibration
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.cost import check_cost
from het_ros.tracking.estimate import Estimate, Patch, State, lasting_deviation
from het_ros.tracking.features.extractor import target_cells
from het_ros.tracking.fitted import FITTED
from het_ros.tracking.middle.appearance import Appearance, Expected, Found
from het_ros.tracking.middle.colour_extent import ColourExtent
from het_ros.tracking.middle.fusion import followed_size
from het_ros.tracking.middle.size import Size
from het_ros.tracking.top.background import Background
from het_ros.tracking.top.confidence import Confidence, Decision, Observation
from het_ros.tracking.top.ego_motion import EgoMotion
from het_ros.tracking.top.kalman import AdaptiveKalman
from het_ros.tracking.top.redetection import Redetection
from het_ros.tracking.top.velocity import VelocityFilter

Floats = NDArray[np.float64]
Image = NDArray[np.uint8]


@dataclass(frozen=True)
class LearningConfig:
    """When the models learn.

    Attributes:
        all: of the first frames each is learnt (chosen: a single one is a poor sample).
        every: of the others one in so many (measured: time, at no loss).
    """

    all: int = 6
    every: int = 2


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
        cells = target_cells((box.w, box.h), config.working_side)
        check_cost(config, cells)
        centre, side = np.array(box.centre), math.sqrt(box.area)
        self._config = config
        self._appearance = Appearance(config, image, box, cells, further)
        self._extent = None if config.network else ColourExtent()
        self._size = Size(
            np.array([box.w, box.h]),
            cells,
            config.scale_rate,
            config.first_frame,
            config.growth_limit,
        )
        self._motion = AdaptiveKalman(
            centre,
            config.acceleration * side,
            config.measurement_noise * side,
            config.nominal_dt,
            config.longest_dt,
        )
        self._velocity = VelocityFilter(centre, side)
        self._network: NetworkEnsemble | None = None
        if config.network:
            self._network = NetworkEnsemble(Path(config.network), config.network_thread)
            self._network.start(image, box)
        self._ego_motion = EgoMotion(image)
        self._background = Background(image.shape, side) if config.background else None
        self._redetection = Redetection()
        self._confidence = Confidence(config.lost_after, calibration)
        self._last_seen = centre
        self._score = 1.0
        self._judged = box
        self._frames = 0
        self._learn(self._appearance.look(image, centre, self._expected()), box, 1.0, 1.0)

    @property
    def confidence(self) -> Confidence:
        """What judges the target; its ``features`` are those of the last frame."""
        return self._confidence

    @property
    def judged(self) -> Box:
        """The box whose place was judged in the last frame, whether or not it was followed."""
        return self._judged

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
        found = self._appearance.find(image, place, self._expected(), proposed)
        self._judged = found.box
        decision = self._judge(found, image, step, witness)
        self._score = decision.score
        if not decision.follow:
            self._coast()
            return self.estimate(decision.score, decision.state)
        self._correct(found, decision)
        self._update_model(found, decision, image, step)
        return self.estimate(decision.score, decision.state, self._appearance.patches_of(found))

    def _follow_scene(self, image: Image, step: float) -> None:
        """Move what is known of the scene with the camera, and the velocity on."""
        self._velocity.predict(step, math.sqrt(float(self._size.size.prod())))
        shift = self._ego_motion.follow(image, step)
        if self._background:
            self._background.move(shift)

    def _search_place(self, image: Image, candidates: Sequence[Box]) -> Floats:
        """(x, y), image px: where the search window goes."""
        size = self._size.size
        coloured = self._config.colour_weight > 0
        return self._redetection.next_place(
            self._confidence.unseen,
            self._motion.centre,
            self._box(self._last_seen),
            self._appearance.extractor.reach(size),
            image,
            self._appearance.colours_of if coloured else None,
            candidates,
        )

    def _expected(self) -> Expected:
        return Expected(self._motion.centre, self._size.size, self._score)

    def _judge(
        self,
        found: Found,
        image: Image,
        dt: float,
        witness: Callable[[Box], bool] | None,
    ) -> Decision:
        """Whether it is the target, or something else that stands there."""
        occluded = witness is not None and not witness(found.box)
        if not occluded and self._background:
            occluded = self._background.shows(image, found.box)
        away = np.array(found.box.centre) - found.look.expected
        side = math.sqrt(found.box.area)
        seen = Observation(
            score=found.score,
            distractor=found.distractor,
            colour=found.colour,
            moved=float(np.hypot(*away)) / side,
            spread=float(found.weights.std()),
            speed=math.hypot(*self._velocity_in_scene()) / side,
            occluded=occluded,
            agreement=found.agreement,
            similarity=found.similarity,
        )
        return self._confidence.judge(seen, dt)

    def _coast(self) -> None:
        """The target is not there: go on as predicted."""
        self._motion.coast()
        self._velocity.coast()
        self._appearance.forget()

    def _correct(self, found: Found, decision: Decision) -> None:
        """The target is in the box that was found: the motion model takes it in."""
        centre = np.array(found.box.centre)
        if decision.returned:
            self._motion.restart(centre)
            self._velocity.restart(centre, math.sqrt(found.box.area))
        else:
            self._velocity.correct(centre)
            self._motion.correct(centre, found.weight)
        self._redetection.forget()
        self._last_seen = centre

    def _update_model(self, found: Found, decision: Decision, image: Image, dt: float) -> None:
        """Size, base ensembles and background follow the target, as far as it is believed."""
        ratio, centre = 1.0, np.array(found.box.centre)
        if self._extent and decision.state is State.TRACKING:
            extractor = self._appearance.extractor
            cell, cells = extractor.cell, np.array(extractor.cells)
            self._extent.follow(
                self._appearance.colour.seen, found.peak.corner * cell, cells * cell
            )
        if decision.weight:
            middle = found.look.middle_of(found.peak.corner)
            ratio = self._size.follow(found.look.frame, middle, self._appearance.flow.flow, dt)
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
        self._appearance.learn(look, box, weight)
        if weight:
            middle = look.frame.window.to_window(np.array(box.centre))
            self._size.learn(look.frame, middle, ratio, weight)

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
        own = self._velocity_in_scene()
        return Estimate(box, motion.total, covariance, score, state, patches, own, motion)

    def _velocity_in_scene(self) -> tuple[float, float]:
        """(x, y), px/s: what is left of the velocity without the camera's motion."""
        x, y = (np.array(self._velocity.motion.total) - self._ego_motion.velocity).tolist()
        return x, y
