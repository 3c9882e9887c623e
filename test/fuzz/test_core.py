# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The tracker itself: any images, boxes and times, in any order; then a target that it follows."""

import math

import numpy as np
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule

from het_ros import Box, TrackerConfig
from het_ros.evaluation.trackers import tracker_of
from het_ros.tracking.estimate import State
from het_ros.tracking.paper.config import PaperConfig

from .cases import COUNTS, cases
from .footage import BOX, frames
from .sane import check_estimate
from .strategies import no_image, pixels

# Small, so that a case is quick; each way through the layers is taken.
CONFIGS = st.sampled_from(
    [
        TrackerConfig(),
        TrackerConfig(features=20, sub_patches=3),
        TrackerConfig(features=1, sub_patches=1),
        TrackerConfig(working_side=8.0, features=10, search_radius=8.0),
        TrackerConfig(background=False, flow_weight=0.0, features=10),
        TrackerConfig(colour_weight=1.0, learning_rate=0.0, ridge=1e-9, features=10),
        TrackerConfig(colour_weight=0.0, scale_rate=1.0, growth_limit=100.0, features=10),
        TrackerConfig(learning_rate=1.0, fast_learning_rate=1.0, first_frame=1.0, features=10),
        TrackerConfig(lost_after=0.0, features=10),
        TrackerConfig(sub_patch_fraction=0.1, features=10),
        TrackerConfig(acceleration=1e4, measurement_noise=1e-4, longest_dt=60.0, features=10),
        TrackerConfig(acceleration=0.0, measurement_noise=10.0, features=10),
        PaperConfig(),
        PaperConfig(features=10, sub_patches=3, search_radius=8.0),
    ]
)
PLACE = st.floats(-300, 300) | st.sampled_from([0.0, -1e9, 1e9, -0.5, 1e300])
SIDE = st.floats(0.01, 200) | st.sampled_from([1e-9, 1.0, 2.0, 4.0])
TIMES = st.sampled_from([1 / 30, 0.0, -1.0, 1e-9, 1e9, 1e300, math.nan, math.inf, -math.inf])
TIMES |= st.floats(-1, 3)


class Core(RuleBasedStateMachine):
    """ValueError for what is no image, time or box, RuntimeError without target; nothing else."""

    @initialize(config=CONFIGS)
    def make(self, config):
        COUNTS["core"] += 1
        self.tracker = tracker_of(config)
        self.last = None

    @rule(image=pixels(), x=PLACE, y=PLACE, w=SIDE, h=SIDE)
    def start(self, image, x, y, w, h):
        state = self.tracker.state
        try:
            estimate = self.tracker.init(image, Box(x, y, w, h))
        except ValueError:
            assert self.tracker.state is state
            return
        check_estimate(estimate)
        assert estimate.state is State.TRACKING
        self.last = image

    @rule(image=pixels(), dt=TIMES)
    def see_anything(self, image, dt):
        self.follow(image, dt)

    @precondition(lambda self: self.last is not None)
    @rule(dt=TIMES, frames=st.integers(1, 5), noise=st.integers(0, 255))
    def see_the_same(self, dt, frames, noise):
        rng = np.random.default_rng(noise)
        for _ in range(frames):
            shaken = self.last.astype(np.int16) + rng.integers(-noise, noise + 1, self.last.shape)
            self.follow(np.clip(shaken, 0, 255).astype(np.uint8), dt)

    @precondition(lambda self: self.last is not None)
    @rule(frames=st.sampled_from([3, 10, 30]), value=st.sampled_from([0, 128, 255]))
    def see_nothing(self, frames, value):
        for _ in range(frames):
            self.follow(np.full_like(self.last, value), 0.1)

    @rule(image=no_image)
    def see_no_image(self, image):
        for call in (
            lambda: self.tracker.init(image, Box(0, 0, 5, 5)),
            lambda: self.tracker.update(image, 0.1),
        ):
            try:
                call()
            except ValueError as error:
                assert str(error)
            else:
                raise AssertionError(f"taken for an image: {image!r}")

    @rule()
    def reset(self):
        self.tracker.reset()
        assert self.tracker.state is State.IDLE

    def follow(self, image, dt):
        idle = self.tracker.state is State.IDLE
        try:
            estimate = self.tracker.update(image, dt)
        except ValueError:
            assert not math.isfinite(dt)
        except RuntimeError:
            assert idle
        else:
            assert estimate.state is self.tracker.state
            check_estimate(estimate)

    def teardown(self):
        """After all that, a new box on a good frame is followed as if nothing had been."""
        if not hasattr(self, "tracker"):
            return
        self.tracker.config = type(self.tracker.config)()
        self.tracker.init(frames()[0], BOX)
        for image in frames()[1:4]:
            estimate = self.tracker.update(image, 1 / 30)
        assert estimate.state is State.TRACKING
        assert estimate.box.iou(Box(BOX.x + 6, BOX.y + 1, BOX.w, BOX.h)) > 0.6


TestCore = Core.TestCase
TestCore.settings = cases(15, stateful_step_count=12)
