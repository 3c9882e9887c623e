# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The scene: everything put together, frame by frame, with its truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from het_ros.scene.camera import CameraState, Lens
from het_ros.scene.clothes import Outfit, outfit
from het_ros.scene.config import SceneConfig
from het_ros.scene.figure import Drawing, Figure
from het_ros.scene.operator import Operator
from het_ros.scene.path import Path
from het_ros.scene.pixels import Piece, lay, overlap
from het_ros.scene.sensor import Sensor
from het_ros.scene.stories import STORIES, Story
from het_ros.scene.street import Street
from het_ros.tracking.box import Box


@dataclass(frozen=True, eq=False)
class Frame:
    """One image and its truth.

    Attributes:
        index: number of the frame, from 0 (-1 where a time was asked for, not a frame).
        stamp: time, s, from 0.
        image: (H, W, 3) uint8 BGR.
        box: the target's silhouette, whole, in px, as if nothing hid it; it may lie outside the
            image. None while the target is beside or behind the camera.
        visible: the part of the silhouette that the image shows, 0..1.
        mask: (H, W) uint8, 255 where the image shows the target.
        others: boxes, px, of the other figures that reach into the image, hidden or not.
        camera: from where it was taken.
    """

    index: int
    stamp: float
    image: np.ndarray
    box: Box | None
    visible: float
    mask: np.ndarray
    others: tuple[Box, ...]
    camera: CameraState


class Scene:
    """A street in which somebody walks: lazy, and the same for the same configuration.

    Example:
        >>> scene = Scene(SceneConfig(story="hidden_1s", seed=3))
        >>> for frame in scene.frames():
        ...     track(frame.image, frame.stamp)

    Args:
        config: what to render.
        story: what happens, instead of the one that ``config.story`` names.
        clothes: the target's, instead of those that the seed draws.
    """

    def __init__(
        self,
        config: SceneConfig | None = None,
        story: Story | None = None,
        clothes: Outfit | None = None,
    ) -> None:
        self.config = config or SceneConfig()
        seeds = np.random.SeedSequence(self.config.seed).spawn(5)
        plot, dress, build, hold, record = (np.random.default_rng(s) for s in seeds)
        self.lens = Lens.wide(self.config.width, self.config.height)
        self.story = story or STORIES[self.config.story](plot)
        self.seconds = self.config.seconds or self.story.seconds
        own = outfit(dress)
        path = Path(self.story.target)
        self._target = Figure(clothes or own, path, dress.uniform(0, 6.28))
        self._passers = [
            Figure(own if p.alike else outfit(dress), Path(p.path), dress.uniform(0, 6.28))
            for p in self.story.passers
        ]
        self._street = Street(build, self.lens, self.story.columns)
        self._operator = Operator(hold, self.story, path, self.config.shake)
        self._sensor = Sensor(record, self.lens, self.config.noise, self.config.exposure)

    def __len__(self) -> int:
        """Number of frames."""
        return max(int(self.seconds * self.config.rate), 1)

    def frames(self) -> Iterator[Frame]:
        """All frames in their order, rendered one at a time."""
        return (self.frame(index) for index in range(len(self)))

    def frame(self, index: int) -> Frame:
        """One frame by its number, seen by the story's own camera."""
        return self.render(index / self.config.rate, index=index)

    def camera_at(self, t: float) -> CameraState:
        """The story's own camera at a time, s."""
        return self._operator.at(t)

    def target_at(self, t: float) -> tuple[float, float]:
        """Where the target stands at a time, s: (x, z) m."""
        body, _ = self._target.body(t)
        return float(body["pelvis"][0]), float(body["pelvis"][2])

    def brightness(self, t: float) -> float:
        """The light at a time, s; 1 is sunlight."""
        times, levels = np.array(self.story.light).T
        return float(np.interp(t, times, levels))

    def render(self, t: float, camera: CameraState | None = None, index: int = -1) -> Frame:
        """The street at a time, s, seen by that camera (by default the story's own)."""
        camera = camera or self.camera_at(t)
        target = self._target.draw(t, camera, self.lens)
        others = self._others(t, camera)
        pieces = self._pieces([target, *others], camera)
        image = np.empty((self.lens.height, self.lens.width, 3), np.uint8)
        self._street.draw_far(image, camera)
        self._cast_shadows(image, [self._target, *self._passers], t, camera)
        for piece in pieces:
            lay(image, piece.picture, piece.column, piece.row)
        mask, visible = self._seen(target, pieces)
        return Frame(
            index=index, stamp=t, image=self._sensor.expose(image, t, camera, self.brightness(t)),
            box=target.box if target else None, visible=visible,
            mask=np.where(mask >= 128, np.uint8(255), np.uint8(0)),
            others=tuple(other.box for other in others), camera=camera,
        )  # fmt: skip

    def _others(self, t: float, camera: CameraState) -> list[Drawing]:
        near = (p for p in self._passers if p.in_image(t, camera, self.lens))
        drawings = (passer.draw(t, camera, self.lens) for passer in near)
        size = self.lens.width, self.lens.height
        return [d for d in drawings if d is not None and d.box.touches_image(*size)]

    def _pieces(self, people: list[Drawing | None], camera: CameraState) -> list[Piece]:
        """All cut-outs that may reach into the image, the farthest first."""
        pieces = self._street.things(camera)
        pieces += [drawing.piece for drawing in people if drawing is not None]
        return sorted(pieces, key=lambda piece: -piece.depth)

    def _seen(self, target: Drawing | None, pieces: list[Piece]) -> tuple[np.ndarray, float]:
        """Alpha (H, W) uint8 of what the image shows of the target, and its part of the whole."""
        mask = np.zeros((self.lens.height, self.lens.width), np.uint8)
        if target is None:
            return mask, 0.0
        for piece in pieces[pieces.index(target.piece) :]:
            window, inner = overlap(mask.shape, piece.picture.shape, piece.column, piece.row)
            if window is None:
                continue
            alpha = piece.picture[inner][..., 3]
            if piece is target.piece:
                mask[window] = alpha
            else:
                mask[window] = cv2.multiply(mask[window], cv2.bitwise_not(alpha), scale=1 / 255)
        whole = target.piece.picture[..., 3].sum(dtype=np.int64)
        return mask, float(mask.sum(dtype=np.int64) / whole)

    def _cast_shadows(
        self, image: np.ndarray, people: list[Figure], t: float, camera: CameraState
    ) -> None:
        for figure in people:
            limbs = figure.shadow(t, camera, self.lens)
            if len(limbs):
                self._cast_shadow(image, limbs)

    def _cast_shadow(self, image: np.ndarray, limbs: np.ndarray) -> None:
        margin = limbs[..., 2].max()
        first, last = limbs[..., :2].min(axis=(0, 1)), limbs[..., :2].max(axis=(0, 1))
        limit = (self.lens.width, self.lens.height)
        left, top = np.clip(np.floor(first - margin), 0, limit).astype(int)
        right, bottom = np.clip(np.ceil(last + margin), 0, limit).astype(int)
        if right <= left or bottom <= top:
            return
        shade = np.full((bottom - top, right - left), 255, np.uint8)
        for ends in limbs:
            start, end = ((ends[:, :2] - (left, top)) * 8).astype(int).tolist()
            thick = ends[:, 2].mean()
            cv2.line(shade, start, end, 140, max(int(thick * 0.45), 1), cv2.LINE_AA, shift=3)
        shade = cv2.cvtColor(cv2.GaussianBlur(shade, (0, 0), 1.2), cv2.COLOR_GRAY2BGR)
        window = image[top:bottom, left:right]
        cv2.multiply(window, shade, dst=window, scale=1 / 255)

    @cached_property
    def visibility(self) -> np.ndarray:
        """``visible`` of every frame, (frames,) float64, found without rendering the images."""
        seen = np.zeros(len(self))
        for index in range(len(self)):
            t = index / self.config.rate
            camera = self.camera_at(t)
            target = self._target.draw(t, camera, self.lens)
            people = [target, *self._others(t, camera)]
            seen[index] = self._seen(target, self._pieces(people, camera))[1]
        return seen

    def hidden_ranges(self, below: float = 0.02) -> list[tuple[int, int]]:
        """Ranges [first, last) of the frames that show less than that part of the target."""
        hidden = np.concatenate([[False], self.visibility < below, [False]])
        edges = np.flatnonzero(hidden[1:] != hidden[:-1])
        return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
