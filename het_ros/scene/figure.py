# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A walking figure: its body drawn limb by limb as shaded tubes, its silhouette and its shadow."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from het_ros.scene.camera import NEAR, CameraState, Lens, project
from het_ros.scene.clothes import TURN, Outfit, Part
from het_ros.scene.gait import STRIDE, joints
from het_ros.scene.ground import SUN, shadow_of
from het_ros.scene.path import Path
from het_ros.scene.pixels import Piece, lay_over
from het_ros.tracking.box import Box

GRAINS = (48.0, 96.0, 192.0, 384.0, 768.0)  # px a metre at which the parts are kept
VIEW_STEP = np.radians(1.5)  # the parts are turned in steps of it
LIMBS = (("thigh", "hip", "knee"), ("shoe", "heel", "toe"), ("shank", "knee", "ankle"))
ARMS = (
    ("hand", "wrist", "hand"),
    ("upper_arm", "shoulder", "elbow"),
    ("forearm", "elbow", "wrist"),
)


@dataclass(frozen=True, eq=False)
class Drawing:
    """A figure as the camera sees it, whole, even where it lies outside the image.

    Attributes:
        piece: its picture and place; the picture's alpha is the silhouette.
        box: the silhouette's tight box, px.
    """

    piece: Piece
    box: Box


class Figure:
    """Somebody who walks along a path.

    Args:
        outfit: clothes and height.
        path: where it walks.
        phase: of its gait at the start, rad.
    """

    def __init__(self, outfit: Outfit, path: Path, phase: float = 0.0) -> None:
        self._outfit, self._path, self._phase = outfit, path, phase
        self._cut: dict[tuple[str, float], _Tube] = {}

    def body(self, t: float) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Joints, (3,) m each, and the unit vector (3,) along which it walks at a time, s."""
        x, z, heading, walked, speed = self._path.at(t)
        forward = np.array([np.sin(heading), 0.0, np.cos(heading)])
        phase = self._phase + 2 * np.pi * walked / (STRIDE * self._outfit.height / 1.75)
        stride = float(np.clip(speed / 0.9, 0, 1))
        return joints(phase, stride, self._outfit.height, forward, np.array([x, 0.0, z])), forward

    def draw(self, t: float, camera: CameraState, lens: Lens) -> Drawing | None:
        """The figure at a time, s, or None where it is not in front of the camera."""
        body, forward = self.body(t)
        places = project(np.array(list(body.values())), camera, lens)
        if places[:, 2].min() < NEAR:
            return None
        seen = dict(zip(body, places, strict=True))
        depth = float(seen["pelvis"][2])
        fine = 2 if lens.focal / depth < 400 else 1  # pixels are drawn at twice the size
        reach = 0.2 * lens.focal / depth + 2
        column, row = (int(np.floor(v - reach)) for v in places[:, :2].min(axis=0))
        right, bottom = (int(np.ceil(v + reach)) for v in places[:, :2].max(axis=0))
        canvas = np.zeros(((bottom - row) * fine, (right - column) * fine, 4), np.uint8)
        put = {name: ((p[:2] - (column, row)) * fine, p[2]) for name, p in seen.items()}
        self._draw_parts(canvas, put, forward, body, camera, lens.focal * fine)
        box = _tight_box(canvas[..., 3], column, row, fine)
        if fine > 1:
            size = (right - column, bottom - row)
            canvas = cv2.resize(canvas, size, interpolation=cv2.INTER_AREA)
        return Drawing(Piece(canvas, column, row, depth), box)

    def in_image(self, t: float, camera: CameraState, lens: Lens) -> bool:
        """Whether the image can show any of the figure at a time, s."""
        x, z, *_ = self._path.at(t)
        column, _, depth = project(np.array([x, 0.0, z]), camera, lens)
        reach = 1.2 * lens.focal / max(depth, NEAR)
        return depth > NEAR and -reach < column < lens.width + reach

    def _draw_parts(
        self, canvas: np.ndarray, put: dict[str, tuple[np.ndarray, float]], forward: np.ndarray,
        body: dict[str, np.ndarray], camera: CameraState, focal: float,
    ) -> None:  # fmt: skip
        to_eye = np.array([camera.x, 0, camera.z]) - body["pelvis"] * (1, 0, 1)
        to_eye /= np.linalg.norm(to_eye)
        left = np.array([-forward[2], 0.0, forward[0]])
        view = float(np.arctan2(to_eye @ left, to_eye @ forward))
        light = _light(to_eye)
        near, far = ("left", "right") if to_eye @ left > 0 else ("right", "left")
        back = "pack" in self._outfit.parts

        def tube(part: str, upper: str, lower: str, shift: np.ndarray | float = 0.0) -> None:
            (start, depth_0), (end, depth_1) = put[upper], put[lower]
            scale = focal / ((depth_0 + depth_1) / 2)
            self._cut_for(part, scale).draw(canvas, start + shift, end + shift, scale, view, light)

        def pack() -> None:
            (start, depth), (end, _) = put["neck"], put["pelvis"]
            sideways = np.array([-to_eye[2], 0, to_eye[0]])  # the image's right, in the street
            off = -0.17 * forward @ sideways * focal / depth
            upper, lower = start * 0.88 + end * 0.12, start * 0.2 + end * 0.8
            shift = np.array([off, 0.0])
            self._cut_for("pack", focal / depth).draw(
                canvas, upper + shift, lower + shift, focal / depth, view, light
            )

        for part, upper, lower in ARMS:
            tube(part, f"{far}_{upper}", f"{far}_{lower}")
        for side in (far, near):
            for part, upper, lower in LIMBS:
                tube(part, f"{side}_{upper}", f"{side}_{lower}")
        facing = to_eye @ forward > 0
        if back and facing:
            pack()
        tube("throat", "head", "neck")
        tube("torso", "neck", "pelvis")
        if back and not facing:
            pack()
        self._draw_head(canvas, put["head"], put["neck"], focal, view, light)
        for part, upper, lower in ARMS:
            tube(part, f"{near}_{upper}", f"{near}_{lower}")

    def _draw_head(
        self, canvas: np.ndarray, head: tuple[np.ndarray, float], neck: tuple[np.ndarray, float],
        focal: float, view: float, light: tuple[float, float],
    ) -> None:  # fmt: skip
        scale = focal / head[1]
        up = (head[0] - neck[0]) / max(np.linalg.norm(head[0] - neck[0]), 1e-6) * 0.004 * scale
        self._cut_for("head", scale).draw(canvas, head[0] + up, head[0] - up, scale, view, light)

    def _cut_for(self, part: str, scale: float) -> _Tube:
        grain = next((g for g in GRAINS if g >= 0.8 * scale), GRAINS[-1])
        if (part, grain) not in self._cut:
            self._cut[part, grain] = _Tube(self._outfit.parts[part], grain)
        return self._cut[part, grain]

    def shadow(self, t: float, camera: CameraState, lens: Lens) -> np.ndarray:
        """The shadow's limbs on the ground: (limbs, 2 ends, column and row and thickness) px."""
        body, _ = self.body(t)
        limbs = [("pelvis", "neck", 0.3), ("neck", "head", 0.17), ("head", "head", 0.2)]
        for side in ("left", "right"):
            limbs += [(f"{side}_{a}", f"{side}_{b}", 0.11) for _, a, b in (*LIMBS, *ARMS)]
        ends = np.array([(body[upper], body[lower]) for upper, lower, _ in limbs])
        seen = project(shadow_of(ends), camera, lens)
        if seen[..., 2].min() < NEAR:
            return seen[:0]
        wide = np.array([wide for *_, wide in limbs])[:, None]
        return np.dstack([seen[..., :2], wide * lens.focal / seen[..., 2]])


def _light(to_eye: np.ndarray) -> tuple[float, float]:
    """The sun's share from the image's right and from the camera, for shading."""
    sun = -SUN * (1, 0, 1)
    sun = 0.85 * sun / np.linalg.norm(sun)
    right = np.array([-to_eye[2], 0.0, to_eye[0]])
    return float(sun @ right), float(sun @ to_eye)


def _tight_box(alpha: np.ndarray, column: int, row: int, fine: int) -> Box:
    columns = np.flatnonzero(cv2.reduce(alpha, 0, cv2.REDUCE_MAX)[0] >= 128)
    rows = np.flatnonzero(cv2.reduce(alpha, 1, cv2.REDUCE_MAX)[:, 0] >= 128)
    return Box(
        column + columns[0] / fine, row + rows[0] / fine,
        (columns[-1] + 1 - columns[0]) / fine, (rows[-1] + 1 - rows[0]) / fine,
    )  # fmt: skip


class _Tube:
    """A part at one resolution, ready to be turned, lit and laid between two joints."""

    def __init__(self, part: Part, grain: float) -> None:
        self._part = part
        rows = max(int(0.55 * grain), 6)
        columns = max(int(max(part.front, part.side) * grain), 5)
        texture = cv2.resize(part.texture, (TURN, rows), interpolation=cv2.INTER_AREA)
        self._texture = np.clip(texture, 0, 255).astype(np.float32)
        down = np.linspace(0, len(part.outline) - 1, rows)
        outline = np.interp(down, np.arange(len(part.outline)), part.outline)[:, None]
        across = ((np.arange(columns) + 0.5) / columns * 2 - 1)[None, :] * 1.06
        self._alpha = np.clip((outline - np.abs(across)) * columns / 2 + 0.5, 0, 1)[..., None]
        self._alpha = self._alpha.astype(np.float32)
        self._sin = np.clip(across / np.maximum(outline, 1e-3), -1, 1).astype(np.float32)
        self._cos = np.sqrt(1 - self._sin**2)
        self._angle = np.arcsin(self._sin)
        self._rows = np.arange(rows)[:, None]
        self._latest: tuple[object, np.ndarray] = (None, np.empty(0))

    def draw(
        self, canvas: np.ndarray, start: np.ndarray, end: np.ndarray, scale: float, view: float,
        light: tuple[float, float],
    ) -> None:  # fmt: skip
        """Lay the part from ``start`` to ``end`` px on a cut-out canvas, ``scale`` px a metre."""
        picture = self._lit(view, light)
        axis = end - start
        length = float(np.hypot(*axis))
        axis = axis / length if length > 1e-6 else np.array([0.0, 1.0])
        wide = np.hypot(self._part.front * np.cos(view), self._part.side * np.sin(view))
        wide *= scale * 1.06
        top = start - axis * self._part.over[0] * scale
        reach = length + sum(self._part.over) * scale
        across = np.array([-axis[1], axis[0]]) * -wide  # the picture's right along the image's
        rows, columns = picture.shape[:2]
        to_canvas = np.column_stack([across / columns, axis * reach / rows, top - across / 2])
        corners = np.array([[0, 0, 1], [columns, 0, 1], [0, rows, 1], [columns, rows, 1]])
        spots = corners @ to_canvas.T
        left, above = np.floor(spots.min(axis=0)).astype(int) - 1
        right, below = np.ceil(spots.max(axis=0)).astype(int) + 1
        to_canvas[:, 2] += to_canvas[:, :2] @ (0.5, 0.5) - 0.5 - (left, above)
        lay_over(
            canvas, cv2.warpAffine(picture, to_canvas, (int(right - left), int(below - above))),
            int(left), int(above),
        )  # fmt: skip

    def _lit(self, view: float, light: tuple[float, float]) -> np.ndarray:
        """The part turned and lit; left and right limbs, and frames alike, share one picture."""
        view, light = round(view / VIEW_STEP) * VIEW_STEP, (round(light[0], 2), round(light[1], 2))
        if (view, light) != self._latest[0]:
            self._latest = (view, light), self._light_up(view, light)
        return self._latest[1]

    def _light_up(self, view: float, light: tuple[float, float]) -> np.ndarray:
        column = ((view + self._angle) / (2 * np.pi) * TURN).astype(int) % TURN
        shade = 0.55 + 0.6 * np.maximum(self._sin * light[0] + self._cos * light[1], 0)
        shade *= 0.72 + 0.28 * self._cos
        colour = np.minimum(self._texture[self._rows, column] * shade[..., None], 255)
        return np.concatenate([colour * self._alpha, self._alpha * 255], axis=2).astype(np.uint8)
