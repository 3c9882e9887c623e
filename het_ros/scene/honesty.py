# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A tracker beside the exact truth of a rendered scene: what it said, and whether that was so."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from het_ros.scene.config import SceneConfig
from het_ros.scene.motion import ImageMotion, image_motion
from het_ros.scene.scene import Frame, Scene
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.features.channels import gray_of
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

CONFIDENT = 0.5  # a score above counts as confident
IN_SIGHT = 0.02  # part of the target that must be seen for it to be visible
WHOLE = 0.9  # part from which on nothing covers it
ON_IT = 0.3  # overlap from which on a box is on somebody


@dataclass(frozen=True)
class Moment:
    """One frame's estimate beside its truth.

    Attributes:
        estimate: what the tracker said.
        visible: part of the target that the image shows, 0..1.
        overlap: of the estimated box with the target's, also where it is hidden.
        elsewhere: the largest with another figure's.
        box: the target's, px, hidden or not; None where it is not before the camera.
        motion: the target's exact motion in the image, where it is known.
    """

    estimate: Estimate
    visible: float
    overlap: float
    elsewhere: float
    box: Box | None = None
    motion: ImageMotion | None = None

    @classmethod
    def of(cls, frame: Frame, estimate: Estimate, motion: ImageMotion | None = None) -> Moment:
        """Of a rendered frame and the answer to it."""
        overlap = estimate.box.iou(frame.box) if frame.box else 0.0
        others = (estimate.box.iou(other) for other in frame.others)
        elsewhere = max(others, default=0.0)
        seen = float(frame.visible)
        return cls(estimate, seen, float(overlap), float(elsewhere), frame.box, motion)

    @property
    def tracked(self) -> bool:
        """Whether it is said to be visible."""
        return self.estimate.state is State.TRACKING

    @property
    def confident(self) -> bool:
        """Whether a robot would act on it."""
        return self.tracked and self.estimate.score > CONFIDENT

    @property
    def on_somebody_else(self) -> bool:
        """Rather on another figure than on the target."""
        return self.elsewhere > ON_IT and self.elsewhere > self.overlap


@dataclass(frozen=True)
class Honesty:
    """How a scene went.

    Attributes:
        f_of_visible: F of TRACKING as the answer to "is the target visible?".
        back_after: s from when it was visible again until the box was on it; None where it was
            never away or the box did not come back.
        ends_on_target: whether the last box is on it.
        confident_wrong: confident frames of which the box is not on the target.
        confident_other: confident frames on another figure after nothing covered the target any
            more.
    """

    f_of_visible: float
    back_after: float | None
    ends_on_target: bool
    confident_wrong: int
    confident_other: int


def followed(
    config: SceneConfig, tracker_config: TrackerConfig | None = None, gray: bool = False
) -> list[Moment]:
    """Render a scene and follow its target from its first frame; ``gray``: without colours."""
    tracker, moments = HierarchicalEnsembleTracker(tracker_config), []
    scene = Scene(config)
    for frame in scene.frames():
        image = gray_of(frame.image) if gray else frame.image
        if frame.index:
            estimate = tracker.update(image, 1 / config.rate)
        else:
            assert frame.box is not None  # every story begins with a visible target
            estimate = tracker.init(image, frame.box)
        moments.append(Moment.of(frame, estimate, image_motion(scene, frame.stamp)))
    return moments


def honesty(moments: list[Moment], rate: float) -> Honesty:
    """Judge a scene; its first frame, which was given, does not count.

    Args:
        moments: all of them.
        rate: frames/s.
    """
    later = moments[1:]
    uncovered = max((i for i, m in enumerate(later) if m.visible < WHOLE), default=-1) + 1
    return Honesty(
        f_of_visible=f_of_visible(later),
        back_after=_back_after(later, rate),
        ends_on_target=later[-1].overlap > ON_IT,
        confident_wrong=sum(m.confident and m.overlap < ON_IT for m in later),
        confident_other=sum(m.confident and m.on_somebody_else for m in later[uncovered:]),
    )


def f_of_visible(moments: Iterable[Moment]) -> float:
    """F of TRACKING as the answer to "is the target visible?", 0..1."""
    said = [(m.tracked, m.visible >= IN_SIGHT) for m in moments]
    right = sum(tracked and visible for tracked, visible in said)
    both = sum(tracked for tracked, _ in said) + sum(visible for _, visible in said)
    return 2 * right / both if both else 1.0


def _back_after(moments: list[Moment], rate: float) -> float | None:
    away = [i for i, m in enumerate(moments) if m.visible < IN_SIGHT]
    if not away:
        return None
    after = moments[away[-1] + 1 :]
    back = next((i for i, m in enumerate(after) if m.tracked and m.overlap > ON_IT), None)
    return None if back is None else back / rate
