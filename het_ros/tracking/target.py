# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of one target: how a frame goes through the layers, and how it is learnt."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.appearance import Appearance
from het_ros.tracking.box import Box
from het_ros.tracking.colour_search import ColourSearch
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.cost import check_cost
from het_ros.tracking.estimate import Estimate, Patch, State, lasting_deviation
from het_ros.tracking.frame import Floats, Frame, Image, Measurement
from het_ros.tracking.inertia import Inertia
from het_ros.tracking.layers import grid, motion_model
from het_ros.tracking.rotation import Rotation
from het_ros.tracking.scenery import Scenery
from het_ros.tracking.search import by_colour, other_size, search_centre
from het_ros.tracking.size import Size
from het_ros.tracking.sub_patches import draw_sub_patches
from het_ros.tracking.trust import Trust, Verdict
from het_ros.tracking.view import View

Witness = Callable[[Box], bool]


class Target:
    """The model of one target; a new target is a new model.

    Args:
        config: parameters.
        image: (H, W, 3) or (H, W) uint8.
        box: the target in it.

    Raises:
        ValueError: it would take more memory than ``most_memory``.
    """

    def __init__(self, config: TrackerConfig, image: Image, box: Box) -> None:
        self._config = config
        self._everyone = np.ones(config.sub_patches, bool)
        rng = np.random.default_rng(config.seed)
        cells, unit = grid(config, box)
        check_cost(config, cells)
        self._sub_patches = draw_sub_patches(
            cells, config.sub_patches, config.sub_patch_fraction, rng
        )
        self._view = View(config, image, box, cells, unit, self._sub_patches.size, rng)
        self._appearance = Appearance(config, cells, self._sub_patches, self._view)
        self._size = Size(config, box, cells)
        sides = [side * config.cell for side in cells]
        self._rotation = Rotation(*sides) if config.rotation else None
        self._trust = Trust(config) if config.trust else None
        self._motion = motion_model(config, box)
        self._seen_at = np.array(box.centre)
        self._inertia = Inertia(image, self._seen_at) if config.camera_motion else None
        remembers = config.trust and config.scenery
        self._scenery = Scenery(image.shape, math.sqrt(box.area)) if remembers else None
        by_colours = config.colour_search and config.colour_weight
        self._colour_search = ColourSearch() if by_colours else None
        frame = self._view.look(image, self._seen_at, 1.0)
        corner = self._appearance.corner_in(frame.window, self._motion.centre)
        self._learn(frame, corner, self._everyone, 1.0)

    def follow(self, image: Image, dt: float, witness: Witness | None = None) -> Estimate:
        """One frame: predict, detect, combine, judge, correct, update the model.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            dt: time since the last frame, s.
            witness: see :meth:`HierarchicalEnsembleTracker.update`.
        """
        self._motion.predict(dt)
        step = self._motion.step(dt)
        self._go_with_camera(image, step)
        if self._rotation:
            self._rotation.predict(step)
        frame, found = self._search(image)
        centre = self._appearance.centre_in(frame.window, found.corner)
        verdict = Verdict.SEEN
        hidden = bool(self._trust and self._trust.hidden_frames)
        if self._trust and found.evidence:
            box = self._box(centre, frame.growth)
            witnessed = witness is None or witness(box)
            if witnessed and self._scenery:
                witnessed = not self._scenery.shows(image, box)
            verdict = self._trust.judge(found.evidence, step, witnessed)
        if verdict is Verdict.HIDDEN:
            self._coast()
        else:
            self._move_to(centre, frame, found, step, hidden)
        if not self._trust and not self.box.touches_image(image.shape[1], image.shape[0]):
            return self.estimate(0.0, State.LOST)
        score = self._update_model(frame, found, verdict, step)
        patches: tuple[Patch, ...] = ()
        if verdict is Verdict.HIDDEN:
            self._appearance.flow.forget()
        else:
            patches = self._sub_patches.in_image(frame.window, found.patch_corners, found.omega)
            upright = self._size.box(self._motion.centre)
            self._appearance.flow.remember(frame.window, upright, step, score)
            if self._scenery:
                self._scenery.remember(image, self.box, step)
        state = self._trust.state if self._trust else State.TRACKING
        return self.estimate(score, state, patches)

    def _coast(self) -> None:
        """The target is not there: go on as predicted."""
        self._motion.coast()
        if self._inertia:
            self._inertia.forget()
        if self._rotation:
            self._rotation.coast()

    def _move_to(
        self, centre: Floats, frame: Frame, found: Measurement, dt: float, hidden: bool
    ) -> None:
        """The target is at ``centre``, px; ``hidden``: it was not seen in the last frame."""
        if hidden:
            self._motion.restart(centre)
        else:
            self._motion.correct(centre, float(found.omega.mean()))
        if self._inertia:
            side = self._size.side(self._size.growth)
            self._motion.change_velocity(self._inertia.observe(centre, side, dt))
        if self._colour_search:
            self._colour_search.forget()
        self._seen_at = centre
        self._size.growth = frame.growth
        if self._rotation:
            place = self._appearance.centre_of(found.corner) * self._config.cell
            self._rotation.observe(frame.window.pixels, place, dt)

    @property
    def box(self) -> Box:
        """The target's box by the motion model, px."""
        return self._box(self._motion.centre)

    def _box(self, centre: Floats, growth: float | None = None) -> Box:
        """The upright box around the target at ``centre``, px, turned as it is now."""
        box = self._size.box(centre, growth)
        return box.turned(self._angle) if self._angle else box

    @property
    def _angle(self) -> float:
        """rad, clockwise: how far windows are turned."""
        return self._rotation.angle if self._rotation else 0.0

    def estimate(self, score: float, state: State, patches: tuple[Patch, ...] = ()) -> Estimate:
        """What the motion model holds, as an estimate."""
        velocity, covariance, box = self._motion.velocity, self._motion.covariance, self.box
        if self._inertia:
            carried = self._inertia.carried
            velocity = velocity[0] + float(carried[0]), velocity[1] + float(carried[1])
        if self._trust:
            lasting = lasting_deviation(score) * np.array([box.w, box.h])
            covariance[:2, :2] += np.diag(lasting**2)
        return Estimate(box, velocity, covariance, score, state, patches)

    def _go_with_camera(self, image: Image, dt: float) -> None:
        """Move what is kept of the target's place by what the camera did, where that counts."""
        if self._inertia:
            shift = self._inertia.shift(image, dt)
            self._motion.shift(shift)
            self._seen_at = self._seen_at + shift
            if self._scenery:
                self._scenery.move(self._inertia.camera_shift)

    def _search(self, image: Image) -> tuple[Frame, Measurement]:
        """Look for the target; for one that is hidden for long also elsewhere at another size."""
        hidden = self._trust.hidden_frames if self._trust else 0
        first = self._look_for(image, hidden, 1.0, self._angle)
        if self._rotation and self._angle and not hidden:
            upright = self._look_for(image, hidden, 1.0, again=True)
            if _shape_of(upright) <= _shape_of(first):
                return first
            self._rotation.forget()
            return upright
        size = other_size(hidden, self._trust.hidden_for) if self._trust else None
        if size is None:
            return first
        second = self._look_for(image, hidden + 1, size, self._angle)
        assert self._trust and first[1].evidence and second[1].evidence
        surely = self._trust.is_surely_back(second[1].evidence, first[1].evidence)
        return second if surely else first

    def _look_for(
        self, image: Image, hidden: int, size: float, angle: float = 0.0, again: bool = False
    ) -> tuple[Frame, Measurement]:
        """One look at the place that is ``hidden``'s turn, at ``size`` times the present size."""
        growth = self._size.growth * size
        reach = self._view.reach(growth)
        if self._colour_search and by_colour(hidden):
            box = self._size.box(self._seen_at, growth)
            colours = self._view.colours
            centre = self._colour_search.next_place(
                image, colours, self._appearance.colour, box, reach
            )
        else:
            centre = search_centre(hidden, self._motion.centre, self._seen_at, reach)
        frame = self._view.look(image, centre, growth, angle, hidden > 0, again)
        side = self._size.side(growth)
        return frame, self._appearance.find(frame, self._motion.centre, self._seen_at, side)

    def _update_model(
        self, frame: Frame, found: Measurement, verdict: Verdict, dt: float
    ) -> float:
        """The three update mechanisms; returns the score of the estimate."""
        if self._trust:
            if verdict is Verdict.SEEN:
                ratio = self._follow_size(frame, found.corner, dt, found.ratio)
                self._learn(frame, found.corner, self._everyone, ratio)
                self._appearance.centre(found)
            return self._trust.score
        corner = self._appearance.corner_in(frame.window, self._motion.centre)
        score, chosen = self._appearance.score_at(frame, found, corner)
        ratio = self._follow_size(frame, corner, dt, found.ratio)
        self._learn(frame, corner, chosen, ratio)
        return score

    def _follow_size(self, frame: Frame, corner: Floats, dt: float, drawn: float) -> float:
        """Take over the change of size; returns the ratio to the size before.

        ``drawn`` is the ratio by which the first frame draws it.
        """
        asked = self._size.asks_template()
        template = self._appearance.template(frame) if asked else None
        middle = self._appearance.middle_of(corner)
        return self._size.follow(frame.planes, middle, dt, template, drawn)

    def _learn(
        self, frame: Frame, corner: Floats, chosen: NDArray[np.bool_], ratio: float
    ) -> None:
        """Learn the target at the layout's ``corner``, cells, ``ratio`` times as large."""
        self._appearance.learn(frame, corner, chosen)
        self._size.learn(frame.planes, self._appearance.middle_of(corner), ratio)
        if self._rotation:
            place = self._appearance.centre_of(corner) * self._config.cell
            self._rotation.learn(frame.window.pixels, place)


def _shape_of(look: tuple[Frame, Measurement]) -> float:
    """Mean score of the sub-patches in a look, 0 where nothing judges it."""
    evidence = look[1].evidence
    return evidence.template if evidence else 0.0
