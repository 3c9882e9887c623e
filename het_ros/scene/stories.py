# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What can happen in the street: who walks where, what hides them, how the light goes.

A story is drawn once a scene from the scene's generator, so every seed tells it a little
differently (speed, depth, moment), but what it is named for happens in each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

Waypoint = tuple[float, float, float]


@dataclass(frozen=True)
class Passer:
    """Another figure.

    Attributes:
        path: waypoints (t s, x m, z m).
        alike: whether it wears the very clothes of the target.
    """

    path: tuple[Waypoint, ...]
    alike: bool = False


@dataclass(frozen=True)
class Column:
    """A poster column: its place and width, m."""

    x: float
    z: float
    width: float


@dataclass(frozen=True)
class Story:
    """Everything that moves, hides or lights.

    Attributes:
        seconds: its length.
        target: waypoints (t s, x m, z m) of the figure to follow.
        passers: the other figures.
        columns: what stands between them and the camera.
        camera: waypoints (t s, x m, z m) of the camera.
        follow: 1 pans with the target, 0 keeps looking along ``yaw``.
        yaw: where a camera that does not pan looks, rad.
        light: points (t s, brightness), 1 is sunlight; a cloud also takes warmth.
    """

    seconds: float
    target: tuple[Waypoint, ...]
    passers: tuple[Passer, ...] = ()
    columns: tuple[Column, ...] = ()
    camera: tuple[Waypoint, ...] = ((0.0, 0.0, 0.0),)
    follow: float = 1.0
    yaw: float = 0.0
    light: tuple[tuple[float, float], ...] = ((0.0, 1.0),)


# Width of a walking silhouette, m, but for the tips of the feet, of which less than 2 % shows.
STEP_WIDTH = 0.66


def _walk(seconds: float, speed: float, z: float, start: float) -> tuple[Waypoint, ...]:
    """Along the promenade to the right, x = start at 0 s; already walking then, and at the end."""
    lead = 1.5  # s
    return (-lead, start - lead * speed, z), (seconds + lead, start + speed * (seconds + lead), z)


def _column_for(hidden: float, speed: float, x: float, z: float, at_z: float) -> Column:
    """The column that hides, for so long, a figure that passes behind it at depth ``at_z``.

    The camera stands at the origin and the lines of sight cross the column at depth ``z``.
    """
    width = (hidden * speed + STEP_WIDTH) * z / at_z
    return Column(x * z / at_z, z, width)


def plain_walk(rng: np.random.Generator) -> Story:
    """Somebody walks along the promenade, the camera pans with them; nothing gets in the way."""
    speed, z = rng.uniform(1.05, 1.35), rng.uniform(5.0, 6.5)
    return Story(8.0, _walk(8.0, speed, z, -4.5))


def _hidden(rng: np.random.Generator, seconds: float) -> Story:
    speed, z = rng.uniform(1.1, 1.3), rng.uniform(5.6, 6.4)
    length = 8.0 + seconds
    start = -0.5 * speed * length
    column = _column_for(seconds, speed, rng.uniform(-0.3, 0.3), 3.4, z)
    return Story(length, _walk(length, speed, z, start), columns=(column,))


def hidden_500ms(rng: np.random.Generator) -> Story:
    """A column hides the target for half a second."""
    return _hidden(rng, 0.5)


def hidden_1s(rng: np.random.Generator) -> Story:
    """A column hides the target for one second."""
    return _hidden(rng, 1.0)


def hidden_2s(rng: np.random.Generator) -> Story:
    """A broad column hides the target for two seconds."""
    return _hidden(rng, 2.0)


def leaves_and_returns(rng: np.random.Generator) -> Story:
    """The camera does not pan: the target walks out of the image, turns and comes back."""
    z = rng.uniform(5.2, 6.2)
    out = 0.6 * z + 1.2
    path = ((-1.5, -2.2, z), (4.2, out, z), (5.2, out + 0.2, z + 0.4), (10.0, -0.6, z + 0.3))
    return Story(10.0, path, follow=0.0)


def lookalike_crosses(rng: np.random.Generator) -> Story:
    """Somebody in the same clothes comes the other way and passes in front of the target."""
    speed, z = rng.uniform(1.05, 1.25), rng.uniform(5.8, 6.4)
    target = _walk(9.0, speed, z, -4.5 * speed)
    other = ((0.0, 5.6, z - 0.9), (9.0, -5.6, z - 0.9))
    return Story(9.0, target, (Passer(other, alike=True),))


def lookalike_at_column(rng: np.random.Generator) -> Story:
    """Two in the same clothes go behind the column from either side and come out again.

    They meet where nobody sees them; only the way they walk tells which of the two comes out
    on the right and is the target.
    """
    speed, z = rng.uniform(1.1, 1.3), rng.uniform(5.6, 6.2)
    column = _column_for(1.0, speed, 0.0, 3.4, z)
    late, length = rng.uniform(-0.35, 0.35), 9.0
    reach = length / 2 * speed
    other = ((late, 1.15 * reach, z + 0.9), (length + late, -1.15 * reach, z + 0.9))
    return Story(
        length, _walk(length, speed, z, -reach), (Passer(other, alike=True),), (column,),
    )  # fmt: skip


def light_change(rng: np.random.Generator) -> Story:
    """A cloud takes more than half of the light and gives it back."""
    speed, z = rng.uniform(1.05, 1.3), rng.uniform(5.0, 6.2)
    light = ((2.0, 1.0), (3.2, 0.45), (5.4, 0.45), (6.2, 1.12), (9.0, 1.0))
    return Story(9.0, _walk(9.0, speed, z, -5.0), light=light)


def approaching(rng: np.random.Generator) -> Story:
    """The target comes from 8 m to 3 m, then turns and goes away: its size grows 2.5 times."""
    x = rng.uniform(-0.6, 0.6)
    path = ((-1.0, x + 3.2, 9.0), (4.8, x - 0.4, 3.2), (5.8, x - 1.2, 3.3), (10.0, x - 2.4, 7.6))
    return Story(10.0, path, follow=0.8)


def follow_walk(rng: np.random.Generator) -> Story:
    """All of it in 22 s: a column, somebody who crosses, a cloud, near and far."""
    target = (
        (0.0, -5.8, 6.3), (8.2, 3.6, 6.3), (11.6, 6.0, 3.9), (15.2, 9.6, 4.2), (18.4, 12.4, 6.6),
        (23.5, 17.4, 7.5),
    )  # fmt: skip
    passers = (
        Passer(((0.0, 16.0, 7.4), (6.5, 8.5, 7.4), (12.0, 2.0, 7.2), (22.0, -10.0, 7.2))),
        Passer(((9.0, 17.5, 4.2), (14.9, 10.2, 3.3), (18.0, 6.0, 3.2), (22.0, 1.0, 3.2))),
    )
    column = Column(-0.25, 3.5, 1.3)
    camera = (
        (0.0, -1.2, 0.0),
        (4.5, -0.6, 0.0),
        (9.5, 2.6, 0.0),
        (16.0, 8.6, 0.0),
        (22.0, 13.2, 0.4),
    )
    light = ((15.8, 1.0), (17.2, 0.55), (19.4, 0.55), (20.6, 1.05))
    return Story(22.0, target, passers, (column,), camera, light=light)


def patrol(rng: np.random.Generator) -> Story:
    """A minute up and down the promenade, behind a column at each turn, and a passer-by.

    Made for a robot that steers the camera: seen from straight ahead the column hides the figure
    for 0.4 s, from aside for more than a second, and a robot that keeps 4 m away from the figure
    never comes within half a metre of the column.
    """
    z, speed = rng.uniform(6.1, 6.4), 0.85
    turns = (-3.0, 4.0, -4.0, 4.0, -4.0, 4.0, -4.0)
    target, t = [(-1.5, turns[0] - 1.5 * speed, z)], 0.0
    for begin, end in pairwise(turns):
        t += abs(end - begin) / speed
        target += [(t, end, z), (t + 1.2, end, z + rng.uniform(-0.1, 0.1))]
        t += 1.2
    column = Column(0.3, z - 0.7, (0.4 * speed + STEP_WIDTH) * (z - 0.7) / z)
    other = ((12.0, 9.0, 7.4), (34.0, -9.0, 7.4), (36.0, -9.0, 7.5), (60.0, 9.0, 7.5))
    return Story(60.0, tuple(target), (Passer(other),), (column,))


STORIES: dict[str, Callable[[np.random.Generator], Story]] = {
    story.__name__: story
    for story in (
        plain_walk, hidden_500ms, hidden_1s, hidden_2s, leaves_and_returns, lookalike_crosses,
        lookalike_at_column, light_change, approaching, follow_walk, patrol,
    )
}  # fmt: skip
