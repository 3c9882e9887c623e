# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of one target: how a frame goes through the layers, and how it is learnt."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking import combination
from het_ros.tracking.base_ensembles import BaseEnsembles, NaiveBayes, detect, scores_at
from het_ros.tracking.box import Box
from het_ros.tracking.channels import channel_stack, names_for
from het_ros.tracking.colour import ColourModel, box_means, cell_means
from het_ros.tracking.compressive import (
    CompressiveFeatures,
    Features,
    draw_measurement_matrix,
    integral_images,
)
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.cost import check_cost
from het_ros.tracking.estimate import Estimate, Patch, State
from het_ros.tracking.motion import AdaptiveKalman
from het_ros.tracking.response import find_peak
from het_ros.tracking.ridge import RidgeEnsembles
from het_ros.tracking.scale import ScaleFilter
from het_ros.tracking.sub_patches import draw_sub_patches, to_be_updated
from het_ros.tracking.trust import Evidence, Trust, TrustLimits, Verdict
from het_ros.tracking.window import Window, cut_window

Image = NDArray[np.uint8]
Floats = NDArray[np.float64]
Witness = Callable[[Box], bool]

# A rival is a place of the target at least this part of its side away from the best one.
_RIVAL_APART = 0.35
# Places around the one where a target was last seen, in search radii.
_SPIRAL = np.array(
    [
        (0, 0),
        (1, 0),
        (-1, 0),
        (0, 1),
        (0, -1),
        (1, 1),
        (-1, -1),
        (1, -1),
        (-1, 1),
        (2, 0),
        (-2, 0),
        (2, 1),
        (-2, -1),
        (2, -1),
        (-2, 1),
        (3, 0),
        (-3, 0),
    ],
    float,
)
_SMALLEST_SIDE = 3.0  # px: below this a target is not shrunk any more


@dataclass(frozen=True)
class Frame:
    """One frame's search window and what all layers read of it.

    Attributes:
        window: the pixels, with its places counted in cells.
        planes: C channels, (H, W) uint8.
        features: (m, rows, columns), maps of the compressive features.
    """

    window: Window
    planes: tuple[Image, ...]
    features: Features


@dataclass(frozen=True)
class Measurement:
    """What bottom and middle layer make of a frame.

    Attributes:
        corner: y_COM, the target's corner, cells of the window.
        patch_corners: p (Q, 2), where the sub-patches were found, cells.
        omega: (Q,) weights of the sub-patches.
        evidence: raw evidence for the place, or None where nothing judges it.
        scores: (Q, rows, columns) of the base ensembles.
    """

    corner: Floats
    patch_corners: Floats
    omega: Floats
    evidence: Evidence | None
    scores: Features


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
        self._first_size = np.array([box.w, box.h])
        self._growth = 1.0
        side = math.sqrt(box.area)
        rng = np.random.default_rng(config.seed)
        self._cells, self._unit = _grid(config, box)
        check_cost(config, self._cells)
        self._radius = config.search_radius / config.cell
        self._sub_patches = draw_sub_patches(
            (self._cells[0], self._cells[1]), config.sub_patches, config.sub_patch_fraction, rng
        )
        self._channels = names_for(config.channels, image)
        self._features = CompressiveFeatures(
            draw_measurement_matrix(
                self._sub_patches.size,
                len(self._channels),
                config.features,
                config.rectangles,
                rng,
                config.largest_rectangle,
            ),
            np.float32 if config.base_ensemble == "ridge" else np.float64,
        )
        self._ensembles = _base_ensembles(config, self._cells)
        self._colour = ColourModel(
            _whole(self._cells, config.cell),
            config.colour_rate,
        )
        self._scale = ScaleFilter(
            _whole(self._cells),
            config.scales,
            config.scale_step,
            config.scale_context,
            config.scale_rate,
        )
        self._trust = Trust(_limits(config)) if config.trust else None
        self._motion = AdaptiveKalman(
            np.array(box.centre),
            config.acceleration * side,
            config.measurement_noise * side,
            config.nominal_dt,
            config.longest_dt,
        )
        self._seen_at = np.array(box.centre)
        frame = self._look(image, self._seen_at)
        self._learn(frame, self._corner_in(frame.window), np.ones(config.sub_patches, bool), 1.0)

    def follow(self, image: Image, dt: float, witness: Witness | None = None) -> Estimate:
        """One frame: predict, detect, combine, judge, correct, update the model.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            dt: time since the last frame, s.
            witness: see :meth:`HierarchicalEnsembleTracker.update`.
        """
        self._motion.predict(dt)
        was_hidden = self._trust is not None and self._trust.hidden_frames > 0
        frame = self._look(image, self._search_centre())
        found = self._measure(frame)
        centre = frame.window.to_image(found.corner + np.array(self._cells) / 2)
        verdict = Verdict.SEEN
        if self._trust and found.evidence:
            witnessed = witness is None or witness(self._box_at(centre))
            verdict = self._trust.judge(found.evidence, self._motion.step(dt), witnessed)
        if verdict is Verdict.HIDDEN:
            self._motion.coast()
        else:
            if was_hidden:
                self._motion.restart(centre)
            else:
                self._motion.correct(centre, float(found.omega.mean()))
            self._seen_at = centre
        if not self._trust and not self.box.touches_image(image.shape[1], image.shape[0]):
            return self.estimate(0.0, State.LOST)
        score = self._update_model(frame, found, verdict)
        state = self._trust.state if self._trust else State.TRACKING
        patches = () if verdict is Verdict.HIDDEN else self._patches(frame.window, found)
        return self.estimate(score, state, patches)

    @property
    def box(self) -> Box:
        """The target's box by the motion model, px."""
        return self._box_at(self._motion.centre)

    def _box_at(self, centre: Floats) -> Box:
        """A box of the target's size, px."""
        width, height = self._first_size * self._growth
        return Box.from_centre(float(centre[0]), float(centre[1]), float(width), float(height))

    def estimate(self, score: float, state: State, patches: tuple[Patch, ...] = ()) -> Estimate:
        """What the motion model holds, as an estimate."""
        return Estimate(
            self.box, self._motion.velocity, self._motion.covariance, score, state, patches
        )

    def _search_centre(self) -> Floats:
        """Where the target is looked for, image px.

        A hidden target is looked for at its prediction in every other frame, and in between
        around the place where it was last seen, farther and farther from it.
        """
        hidden = self._trust.hidden_frames if self._trust else 0
        if hidden % 2 == 0:
            return self._motion.centre
        step = (hidden // 2) % min(1 + hidden // 2, len(_SPIRAL))
        reach = self._radius * self._unit * self._growth
        return np.asarray(self._seen_at + _SPIRAL[step] * reach)

    def _look(self, image: Image, centre: Floats) -> Frame:
        """The window with every place at which a sub-patch is looked for, and its maps."""
        config = self._config
        whole = config.working_side > 0
        margin = math.ceil(self._radius) + (0 if whole else 1)
        unit = self._unit * self._growth
        corner = centre - np.array([self.box.w, self.box.h]) / 2 - margin * unit
        width, height = (math.ceil(cells) + 2 * margin for cells in self._cells)
        scale = config.cell / unit
        window = cut_window(
            image,
            float(corner[0]),
            float(corner[1]),
            width * config.cell,
            height * config.cell,
            (float(scale[0]), float(scale[1])),
        )
        planes = channel_stack(window.pixels, self._channels, config.cell)
        features = self._features.maps(integral_images(planes))
        return Frame(window.in_cells(config.cell), planes, features)

    def _measure(self, frame: Frame) -> Measurement:
        """Bottom and middle layer."""
        scores = self._ensembles.score_maps(frame.features)
        if self._config.combination == "weighted":
            return self._weighted(frame, scores)
        return self._dense(frame, scores)

    def _weighted(self, frame: Frame, scores: Features) -> Measurement:
        """The paper's middle layer: one hypothesis a sub-patch, weighted by its score."""
        config = self._config
        expected = self._sub_patches.corners(self._corner_in(frame.window))
        found = detect(scores, expected, self._radius)
        omega = combination.weights(found.scores, config.weight_low, config.weight_high)
        candidates = combination.hypotheses(found.corners, self._sub_patches.offsets)
        corner = combination.combine(candidates, omega)
        return Measurement(corner, found.corners, omega, None, scores)

    def _dense(self, frame: Frame, scores: Features) -> Measurement:
        """All sub-patches and the colours vote for every place of the target."""
        config = self._config
        rows, columns = (
            side - max_offset
            for side, max_offset in zip(
                scores.shape[1:],
                (
                    round(self._cells[1]) - self._sub_patches.size[1],
                    round(self._cells[0]) - self._sub_patches.size[0],
                ),
                strict=True,
            )
        )
        colour = np.zeros((rows, columns), np.float32)
        if config.colour_weight:
            likelihood = cell_means(self._colour.likelihood(frame.window.pixels), config.cell)
            colour = box_means(likelihood, _whole(self._cells), (rows, columns))
        offsets = self._sub_patches.offsets.astype(np.intp)
        apart = (
            max(2, round(_RIVAL_APART * self._cells[0])),
            max(2, round(_RIVAL_APART * self._cells[1])),
        )
        peak = find_peak(scores, offsets, colour, config.colour_weight, apart)
        omega = np.clip(peak.patch_scores, config.weight_low, config.weight_high)
        evidence = Evidence(peak.template, peak.colour, peak.rival)
        corners = self._sub_patches.corners(peak.corner)
        return Measurement(peak.corner, corners, omega, evidence, scores)

    def _update_model(self, frame: Frame, found: Measurement, verdict: Verdict) -> float:
        """The three update mechanisms; returns the score of the estimate."""
        if self._trust:
            if verdict is Verdict.SEEN:
                chosen = np.ones(self._config.sub_patches, bool)
                self._learn(frame, found.corner, chosen, self._resize(frame, found.corner))
            return self._trust.score
        target = self._corner_in(frame.window)
        corners = self._sub_patches.corners(target)
        score = self._ensembles.likelihood(frame.features, corners)
        chosen = to_be_updated(scores_at(found.scores, corners))
        self._learn(frame, target, chosen, self._resize(frame, target))
        return score

    def _resize(self, frame: Frame, corner: Floats) -> float:
        """Follow the target's change of size; returns the ratio to the size before."""
        if self._config.scales == 1:
            return 1.0
        ratio = self._scale.change(frame.planes, corner + np.array(self._cells) / 2)
        least = _SMALLEST_SIDE / float(self._first_size.min())
        growth = max(self._growth * ratio, min(self._growth, least))
        ratio, self._growth = growth / self._growth, growth
        return ratio

    def _learn(
        self, frame: Frame, corner: Floats, chosen: NDArray[np.bool_], ratio: float
    ) -> None:
        """Re-extract the sub-patches at the target's ``corner``, cells, and learn them."""
        config = self._config
        self._ensembles.learn(frame.features, self._sub_patches.corners(corner), chosen)
        if config.colour_weight:
            x, y = corner * config.cell
            self._colour.learn(frame.window.pixels, (float(x), float(y)))
        if config.scales > 1:
            self._scale.learn(frame.planes, corner + np.array(self._cells) / 2, ratio)

    def _corner_in(self, window: Window) -> Floats:
        """The target's corner by the motion model, cells of the window."""
        return window.to_window(np.array([self.box.x, self.box.y]))

    def _patches(self, window: Window, found: Measurement) -> tuple[Patch, ...]:
        """The sub-patches where they were found, in image px."""
        width, height = (np.array(self._sub_patches.size) / np.array(window.scale)).tolist()
        corners = window.to_image(found.patch_corners).tolist()
        return tuple(
            Patch(Box(x, y, width, height), weight)
            for (x, y), weight in zip(corners, found.omega.tolist(), strict=True)
        )


def _grid(config: TrackerConfig, box: Box) -> tuple[tuple[float, float], Floats]:
    """Size (w, h) of the target in cells, and the image px (x, y) that a cell covers at first.

    At a working resolution the target is a whole number of cells.
    """
    if not config.working_side:
        return (box.w / config.cell, box.h / config.cell), np.full(2, float(config.cell))
    side = config.working_side / config.cell / math.sqrt(box.area)
    width, height = (max(4, round(length * side)) for length in (box.w, box.h))
    return (width, height), np.array([box.w / width, box.h / height])


def _whole(cells: tuple[float, float], unit: int = 1) -> tuple[int, int]:
    """A size (w, h) in cells of ``unit`` px in whole px; of the smallest target at least 1."""
    return max(1, round(cells[0] * unit)), max(1, round(cells[1] * unit))


def _base_ensembles(config: TrackerConfig, cells: tuple[float, float]) -> BaseEnsembles:
    if config.base_ensemble == "ridge":
        sigma = config.label_sigma * math.sqrt(cells[0] * cells[1])
        return RidgeEnsembles(
            1 - config.learning_rate, config.ridge, (sigma, sigma), config.target_emphasis
        )
    return NaiveBayes(
        config.learning_rate,
        config.positive_radius / config.cell,
        config.negative_radius / config.cell,
        config.sigma_floor,
    )


def _limits(config: TrackerConfig) -> TrustLimits:
    return TrustLimits(
        hidden=config.hidden,
        learn_colour=config.learn_colour,
        twin=config.twin,
        doubt_template=config.doubt_template,
        doubt_rival=config.doubt_rival,
        return_template=config.return_template,
        lost_after=config.lost_after,
    )
