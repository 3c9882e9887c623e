# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The street as it stands: ground, houses, sky, and the things on the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from het_ros.scene import props
from het_ros.scene.backdrop import Houses, Panorama
from het_ros.scene.camera import CameraState, Lens, project
from het_ros.scene.ground import Ground
from het_ros.scene.pixels import Piece
from het_ros.scene.stories import Column


class Street:
    """All that does not move.

    Args:
        columns: the story's poster columns; trees, lamps and bushes come with the street.
    """

    def __init__(self, rng: np.random.Generator, lens: Lens, columns: Sequence[Column]) -> None:
        self._lens = lens
        self._panorama = Panorama(rng, lens)
        self._houses = Houses(rng)
        trees = [props.tree(rng, tall) for tall in (4.6, 5.4)]
        bushes = [props.bush(rng, aspect) for aspect in (1.4, 2.2)]
        lamp = props.lamp(rng)
        self._things: list[props.Placed] = []
        shadows = []
        for k, x in enumerate(np.arange(-27, 28, 6.0) + rng.uniform(-0.8, 0.8, 10)):
            tall = rng.uniform(4.2, 5.4)
            z = 9.3 + rng.uniform(-0.4, 0.4)
            self._things.append(props.placed(trees[k % 2], x, z, tall))
            shadows.append((x, z, 1.4, 0.66 * tall))
        for x in np.arange(-24, 25, 12.0):
            self._things.append(props.placed(lamp, x, 8.45, 4.0))
            shadows.append((x, 8.45, 0.14, 4.0))
        for k, x in enumerate(rng.uniform(-28, 28, 18)):
            z, tall = rng.uniform(8.7, 10.0), rng.uniform(0.5, 0.95)
            self._things.append(props.placed(bushes[k % 2], x, z, tall))
            shadows.append((x, z, 0.5, tall))
        for column in columns:
            picture = props.poster_column(rng, column.width)
            self._things.append(props.placed(picture, column.x, column.z, 2.75))
            shadows.append((column.x, column.z, column.width, 2.75))
        self._ground = Ground(rng, shadows)

    def draw_far(self, image: np.ndarray, camera: CameraState) -> None:
        """Fill an image (H, W, 3) uint8 with sky, ground and houses, in place."""
        self._panorama.draw(image, camera, self._lens)
        self._ground.draw(image, camera, self._lens)
        self._houses.draw(image, camera, self._lens)

    def things(self, camera: CameraState) -> list[Piece]:
        """What stands on the ground, as far as the image shows it."""
        seen = []
        feet = project(
            np.array([(thing.x, 0.0, thing.z) for thing in self._things]), camera, self._lens
        )
        for thing, (column, row, depth) in zip(self._things, feet, strict=True):
            drawn = thing.drawn(column, row, depth, self._lens)
            if drawn is not None:
                seen.append(Piece(*drawn, float(depth)))
        return seen
