# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The model of one target: the six steps of the paper's Figure 1."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Estimate, Patch, State
from het_ros.tracking.features.buffers import Buffers
from het_ros.tracking.features.compressive import FeatureMaps
from het_ros.tracking.features.frame import Frame
from het_ros.tracking.features.window import Pixels, Window
from het_ros.tracking.paper.appearance import LocalAppearance, draw_sub_patches
from het_ros.tracking.paper.base_ensembles import mean_probability, score_maps
from het_ros.tracking.paper.combination import combine, hypotheses, weights
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.paper.detection import Detections, detect, scores_at
from het_ros.tracking.paper.kalman import AdaptiveKalman
from het_ros.tracking.paper.model_update import (
    Choice,
    class_gaussians,
    to_be_updated,
    updated,
)
from het_ros.tracking.paper.weak_classifiers import Gaussians, WeakClassifiers

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Measurement:
    """What the middle layer makes of the detected sub-patches.

    Attributes:
        centre: z = y_COM as the target's centre (2,), image px.
        weights: omega (Q,).
    """

    centre: Floats
    weights: Floats


@dataclass(frozen=True)
class ReExtraction:
    """The sub-patches put back into the layout of the first frame.

    Attributes:
        corners: p (Q, 2), px of the window.
        chosen: (Q,), which of them are to be updated.
    """

    corners: Floats
    chosen: Choice


class Target:
    """The model of one target; a new target is a new model.

    The state of the top layer is the target's centre in image px, the layers below count from its
    corner in px of the window: :meth:`_corner_in` and :meth:`_centre_in` convert.

    Args:
        config: parameters.
        image: (H, W, 3) or (H, W) uint8.
        box: the target in it.

    Raises:
        ValueError: it would take more memory than ``most_memory``.
    """

    def __init__(self, config: PaperConfig, image: Pixels, box: Box) -> None:
        self._config = config
        self._size = np.array([box.w, box.h])
        self._squares, self._samples = Buffers(), Buffers()
        rng = np.random.default_rng(config.seed)
        sides = box.w, box.h
        self._patches = draw_sub_patches(sides, config.sub_patches, config.sub_patch_fraction, rng)
        gray = image.ndim == 2
        self._appearance = LocalAppearance(config, sides, self._patches.size, gray, rng)
        side = math.sqrt(box.area)
        self._kalman = AdaptiveKalman(
            np.array(box.centre),
            config.acceleration * side,
            config.measurement_noise * side,
            config.nominal_dt,
            config.longest_dt,
        )
        frame = self._appearance.frame(image, self._kalman.centre)
        corners = self._patches.corners(self._corner_in(frame.window, self._kalman.centre))
        positive, negative = self._class_gaussians(frame, corners)
        self._classifiers = WeakClassifiers(positive, negative, config.sigma_floor)

    def follow(self, image: Pixels, dt: float) -> Estimate:
        """One frame, by the six steps of the paper's Figure 1.

        Args:
            image: (H, W, 3) or (H, W) uint8.
            dt: time since the last frame, s.
        """
        frame = self._appearance.frame(image, self._kalman.predict(dt))
        scores = score_maps(self._classifiers, frame.features, self._squares)

        found = self._detect_sub_patches(frame, scores)  # 1
        measured = self._combine_base_ensembles(frame, found)  # 2
        self._kalman.adapt(float(measured.weights.mean()))  # 3
        self._kalman.correct(measured.centre)  # 4
        if not self.box.touches_image(image.shape[1], image.shape[0]):
            return self.estimate(0.0, State.LOST)
        extracted = self._re_extract_sub_patches(frame, scores)  # 5
        score = mean_probability(self._classifiers, frame.features, extracted.corners)
        self._update_weak_classifiers(frame, extracted)  # 6

        patches = self._patches.in_image(frame.window, found.corners, measured.weights)
        return self.estimate(score, State.TRACKING, patches)

    def _detect_sub_patches(self, frame: Frame, scores: FeatureMaps) -> Detections:
        """Step 1, bottom layer: where the base ensembles find the sub-patches, eq. (7).

        Args:
            frame: of the image.
            scores: F (Q, rows, columns) by the base ensembles, eqs. (4) to (6).
        """
        corner = self._corner_in(frame.window, self._kalman.centre)
        return detect(scores, self._patches.corners(corner), self._config.search_radius)

    def _combine_base_ensembles(self, frame: Frame, found: Detections) -> Measurement:
        """Step 2, middle layer: the measurement of the target, eqs. (8) and (9)."""
        omega = weights(found.scores, self._config.weight_low, self._config.weight_high)
        candidates = hypotheses(found.corners, self._patches.offsets)
        return Measurement(self._centre_in(frame.window, combine(candidates, omega)), omega)

    def _re_extract_sub_patches(self, frame: Frame, scores: FeatureMaps) -> ReExtraction:
        """Step 5, middle layer: the sub-patches anew at the estimate, and eq. (17) of them."""
        corners = self._patches.corners(self._corner_in(frame.window, self._kalman.centre))
        return ReExtraction(corners, to_be_updated(scores_at(scores, corners)))

    def _update_weak_classifiers(self, frame: Frame, extracted: ReExtraction) -> None:
        """Step 6, bottom layer: the Gaussians of the chosen sub-patches, eq. (18)."""
        positive, negative = self._class_gaussians(frame, extracted.corners)
        rate = self._config.learning_rate
        self._classifiers = updated(self._classifiers, positive, negative, rate, extracted.chosen)

    def _class_gaussians(self, frame: Frame, corners: Floats) -> tuple[Gaussians, Gaussians]:
        """The frame's positive and negative samples of the sub-patches at ``corners`` (Q, 2)."""
        near, far = self._config.positive_radius, self._config.negative_radius
        return class_gaussians(frame.features, corners, near, far, self._samples)

    @property
    def box(self) -> Box:
        """The target's box by the top layer, px; its size is that of the first box."""
        return Box.from_centre(*self._kalman.centre.tolist(), *self._size.tolist())

    def estimate(self, score: float, state: State, patches: tuple[Patch, ...] = ()) -> Estimate:
        """What the top layer holds, as an estimate."""
        kalman = self._kalman
        return Estimate(self.box, kalman.velocity, kalman.covariance, score, state, patches)

    def _corner_in(self, window: Window, centre: Floats) -> Floats:
        """The corner, px of the window, of a target with its ``centre`` there, image px."""
        return window.to_window(centre) - self._size / 2

    def _centre_in(self, window: Window, corner: Floats) -> Floats:
        """The centre, image px, of a target with its ``corner`` there, px of the window."""
        return window.to_image(corner + self._size / 2)
