"""The scene: everything put together, frame by frame, with its truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from het_ros.scene.camera import CameraState, Lens
from het_ros.scene.clothes import Outfit, outfit
from het_ros.scene.config import SceneConfig
from het_ros.scene.figure import Drawing, Figure
from het_ros.scene.operator import Operator
from het_ros.scene.path import Path
from het_ros.scene.pixels import lay, overlap
from het_ros.scene.sensor import Sensor
from het_ros.scene.stories import STORIES
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
        camera: from where it was taken.
    """

    index: int
    stamp: float
    image: np.ndarray
    box: Box | None
    visible: float
    mask: np.ndarray
    camera: CameraState


class Scene:
    """A street in which somebody walks: lazy, and the same for the same configuration.

    Example:
        >>> scene = Scene(SceneConfig(story="hidden_1s", seed=3))
        >>> for frame in scene.frames():
        ...     track(frame.image, frame.stamp)

    Args:
        config: what to render.
        clothes: the target's, instead of those that the seed draws.
    """

    def __init__(self, config: SceneConfig | None = None, clothes: Outfit | None = None) -> None:
        self.config = config or SceneConfig()
        seeds = np.random.SeedSequence(self.config.seed).spawn(5)
        plot, dress, build, hold, record = (np.random.default_rng(s) for s in seeds)
        self.lens = Lens.wide(self.config.width, self.config.height)
        self.story = STORIES[self.config.story](plot)
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
        image = np.empty((self.lens.height, self.lens.width, 3), np.uint8)
        self._street.draw_far(image, camera)
        people = [self._target, *self._passers]
        self._cast_shadows(image, people, t, camera)
        target = self._target.draw(t, camera, self.lens)
        mask = np.zeros(image.shape[:2], np.uint8)
        for piece, column, row, is_target in self._by_depth(target, t, camera):
            window = lay(image, piece, column, row)
            if window is not None:
                _, inner = overlap(mask.shape, piece.shape, column, row)
                alpha = piece[inner][..., 3]
                if is_target:
                    mask[window] = alpha
                else:
                    mask[window] = cv2.multiply(mask[window], cv2.bitwise_not(alpha), scale=1 / 255)
        visible = float(mask.sum(dtype=np.int64) / target.picture[..., 3].sum()) if target else 0.0
        return Frame(
            index=index, stamp=t, image=self._sensor.expose(image, t, camera, self.brightness(t)),
            box=target.box if target else None, visible=min(visible, 1.0),
            mask=np.where(mask >= 128, np.uint8(255), np.uint8(0)), camera=camera,
        )  # fmt: skip

    def _by_depth(
        self, target: Drawing | None, t: float, camera: CameraState
    ) -> list[tuple[np.ndarray, int, int, bool]]:
        """All cut-outs (picture, column, row, whether the target), the farthest first."""
        pieces = [(d, *place, False) for d, *place in self._street.things(camera)]
        drawings = [(target, True)] + [(p.draw(t, camera, self.lens), False) for p in self._passers]
        for drawing, is_target in drawings:
            if drawing is not None:
                pieces.append(
                    (drawing.depth, drawing.picture, drawing.column, drawing.row, is_target)
                )
        return [tuple(rest) for _, *rest in sorted(pieces, key=lambda piece: -piece[0])]

    def _cast_shadows(
        self, image: np.ndarray, people: list[Figure], t: float, camera: CameraState
    ) -> None:
        lines = [line for figure in people for line in figure.shadow(t, camera, self.lens)]
        if not lines:
            return
        ends = np.concatenate(lines)
        top = int(np.clip(ends[:, 1].min() - 12, 0, self.lens.height))
        bottom = int(np.clip(ends[:, 1].max() + 12, 0, self.lens.height))
        left = int(np.clip(ends[:, 0].min() - 40, 0, self.lens.width))
        right = int(np.clip(ends[:, 0].max() + 40, 0, self.lens.width))
        if right <= left or bottom <= top:
            return
        shade = np.full((bottom - top, right - left), 255, np.uint8)
        for (x0, y0, thick), (x1, y1, _) in lines:
            ends = [(int((x - left) * 8), int((y - top) * 8)) for x, y in ((x0, y0), (x1, y1))]
            cv2.line(shade, *ends, 140, max(int(thick * 0.45), 1), cv2.LINE_AA, shift=3)
        shade = cv2.cvtColor(cv2.GaussianBlur(shade, (0, 0), 1.2), cv2.COLOR_GRAY2BGR)
        window = image[top:bottom, left:right]
        cv2.multiply(window, shade, dst=window, scale=1 / 255)

    def visibility(self) -> np.ndarray:
        """``visible`` of every frame, (frames,) float64."""
        return np.array([frame.visible for frame in self.frames()])

    def hidden_ranges(self, below: float = 0.02) -> list[tuple[int, int]]:
        """Ranges [first, last) of the frames that show less than that part of the target."""
        hidden = np.concatenate([[False], self.visibility() < below, [False]])
        edges = np.flatnonzero(hidden[1:] != hidden[:-1])
        return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
