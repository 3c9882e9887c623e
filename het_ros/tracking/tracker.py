"""The Hierarchical Ensemble Tracker: the layers joined, from an image to an estimate."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from het_ros.tracking import combination
from het_ros.tracking.base_ensembles import (
    BaseEnsembles,
    Detections,
    NaiveBayes,
    detect,
    scores_at,
)
from het_ros.tracking.box import Box
from het_ros.tracking.channels import channel_stack, names_for
from het_ros.tracking.compressive import (
    CompressiveFeatures,
    Features,
    draw_measurement_matrix,
    integral_images,
)
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, Patch, State
from het_ros.tracking.motion import AdaptiveKalman
from het_ros.tracking.sub_patches import draw_sub_patches, to_be_updated
from het_ros.tracking.window import Window, cut_window

Image = NDArray[np.uint8]
Floats = NDArray[np.float64]


class HierarchicalEnsembleTracker:
    """Follows one target through a stream of images.

    The same seed, boxes and images give the same estimates, to the bit.

    Args:
        config: its parameters; by default ``TrackerConfig()``.
    """

    def __init__(self, config: TrackerConfig | None = None) -> None:
        self.config = config or TrackerConfig()
        self._target: _Target | None = None
        self._state = State.IDLE

    @property
    def state(self) -> State:
        """IDLE before :meth:`init` and after :meth:`reset`, else the last estimate's state."""
        return self._state

    def reset(self) -> None:
        """Forget the target."""
        self._target = None
        self._state = State.IDLE

    def init(self, image: Image, box: Box) -> Estimate:
        """Start on a target; a target that was followed before is forgotten.

        Args:
            image: (H, W, 3) uint8 BGR or (H, W) uint8.
            box: the target in it; it may reach over the border.

        Returns:
            The estimate of this first frame.

        Raises:
            ValueError: the image is not of that kind, or the box lies wholly outside it. The
                target followed before stays.
        """
        _check_image(image)
        height, width = image.shape[:2]
        if not box.touches_image(width, height):
            raise ValueError(
                f"the box {box.as_tuple()} lies wholly outside the image of {width} x {height} "
                "px: send x, y, w, h in px of this image"
            )
        self._target = _Target(self.config, image, box)
        self._state = State.TRACKING
        return self._target.estimate(1.0, State.TRACKING)

    def update(self, image: Image, dt: float) -> Estimate:
        """Find the target in the next image.

        When the estimated box leaves the image the target is LOST and stays so until the next
        :meth:`init`.

        Args:
            image: (H, W, 3) uint8 BGR or (H, W) uint8; size and kind may differ from the last.
            dt: time since the last image, s. Where it is not positive the configuration's
                ``nominal_dt`` is taken.

        Returns:
            The estimate of this frame.

        Raises:
            ValueError: the image is not of that kind, or ``dt`` is NaN or infinite.
            RuntimeError: there is no target.
        """
        _check_image(image)
        if not math.isfinite(dt):
            raise ValueError(f"dt must be a finite number of seconds, not {dt}")
        if self._target is None:
            raise RuntimeError("there is no target to update: call init first")
        if self._state is State.LOST:
            return self._target.estimate(0.0, State.LOST)
        estimate = self._target.follow(image, dt)
        self._state = estimate.state
        return estimate


class _Target:
    """The model of one target, and how a frame goes through the layers."""

    def __init__(self, config: TrackerConfig, image: Image, box: Box) -> None:
        self._config = config
        self._size = (box.w, box.h)
        side = math.sqrt(box.area)
        self._scale = config.working_side / side if config.working_side else 1.0
        rng = np.random.default_rng(config.seed)
        working = (box.w * self._scale, box.h * self._scale)
        self._sub_patches = draw_sub_patches(
            working, config.sub_patches, config.sub_patch_fraction, rng
        )
        self._channels = names_for(config.channels, image)
        self._features = CompressiveFeatures(
            draw_measurement_matrix(
                self._sub_patches.size,
                len(self._channels),
                config.features,
                config.rectangles,
                rng,
            )
        )
        self._ensembles: BaseEnsembles = NaiveBayes(
            config.learning_rate,
            config.positive_radius,
            config.negative_radius,
            config.sigma_floor,
        )
        self._motion = AdaptiveKalman(
            np.array(box.centre),
            config.acceleration * side,
            config.measurement_noise * side,
            config.nominal_dt,
            config.longest_dt,
        )
        window = self._search_window(image)
        corners = self._sub_patches.corners(self._corner_in(window))
        everyone = np.ones(config.sub_patches, bool)
        self._ensembles.learn(self._feature_maps(window), corners, everyone)

    def follow(self, image: Image, dt: float) -> Estimate:
        """One frame: predict, detect, combine, correct, update the model."""
        self._motion.predict(dt)
        window = self._search_window(image)
        features = self._feature_maps(window)
        scores = self._ensembles.score_maps(features)
        expected = self._sub_patches.corners(self._corner_in(window))
        found = detect(scores, expected, self._config.search_radius)
        omega = combination.weights(
            found.scores, self._config.weight_low, self._config.weight_high
        )
        candidates = combination.hypotheses(found.corners, self._sub_patches.offsets)
        corner = window.to_image(combination.combine(candidates, omega))
        self._motion.correct(corner + np.array(self._size) / 2, float(omega.mean()))

        if not self.box.touches_image(image.shape[1], image.shape[0]):
            return self.estimate(0.0, State.LOST)
        corners = self._sub_patches.corners(self._corner_in(window))
        new_scores = scores_at(scores, corners)
        likelihood = self._ensembles.likelihood(features, corners)
        self._ensembles.learn(features, corners, to_be_updated(new_scores))
        patches = self._patches(window, found, omega)
        return self.estimate(likelihood, State.TRACKING, patches)

    @property
    def box(self) -> Box:
        """The target's box by the motion model, px."""
        cx, cy = self._motion.centre
        return Box.from_centre(float(cx), float(cy), *self._size)

    def estimate(self, score: float, state: State, patches: tuple[Patch, ...] = ()) -> Estimate:
        """What the motion model holds, as an estimate."""
        return Estimate(
            self.box, self._motion.velocity, self._motion.covariance, score, state, patches
        )

    def _search_window(self, image: Image) -> Window:
        """The window with every place at which a sub-patch is looked for."""
        margin = math.ceil(self._config.search_radius) + 1
        box, scale = self.box, self._scale
        return cut_window(
            image,
            box.x - margin / scale,
            box.y - margin / scale,
            math.ceil(box.w * scale) + 2 * margin,
            math.ceil(box.h * scale) + 2 * margin,
            scale,
        )

    def _feature_maps(self, window: Window) -> Features:
        channels = channel_stack(window.pixels, self._channels)
        return self._features.maps(integral_images(channels))

    def _corner_in(self, window: Window) -> Floats:
        """The target's corner, window px."""
        return window.to_window(np.array([self.box.x, self.box.y]))

    def _patches(self, window: Window, found: Detections, omega: Floats) -> tuple[Patch, ...]:
        """The sub-patches where they were found, in image px."""
        width, height = (
            side / scale for side, scale in zip(self._sub_patches.size, window.scale, strict=True)
        )
        corners = window.to_image(found.corners)
        return tuple(
            Patch(Box(float(x), float(y), width, height), float(weight))
            for (x, y), weight in zip(corners, omega, strict=True)
        )


def _check_image(image: Image) -> None:
    """Raise ValueError unless the image is (H, W, 3) or (H, W) uint8 with at least one px."""
    if not isinstance(image, np.ndarray) or image.dtype != np.uint8:
        kind = getattr(image, "dtype", type(image).__name__)
        raise ValueError(f"an image must be a uint8 array, not {kind}: convert it first")
    if image.size == 0 or image.ndim not in (2, 3) or (image.ndim == 3 and image.shape[2] != 3):
        raise ValueError(
            f"an image must be of shape (H, W, 3) in BGR order or (H, W), not {image.shape}"
        )
