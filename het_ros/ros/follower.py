# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A follower's control law with its dead man's switch; plain Python, so that it can be tested."""

from __future__ import annotations

import math
from dataclasses import dataclass

from het_ros.ros.feed_forward import FeedForward
from het_ros.ros.reckoning import Reckoning
from het_ros.tracking.estimate import State
from het_ros.tracking.parameter import check_parameters, parameter

LONGEST_PREDICTION = 4.0  # s
EASED = 0.6  # of the gains, while the target's own velocity is fed forward


@dataclass(frozen=True)
class FollowerConfig:
    """Settings of the follower.

    Raises:
        ValueError: a value is of the wrong type or outside its range.
    """

    distance: float = parameter(2.0, "kept to the target", unit="m", low=0.3, high=20.0)
    drive_gain: float = parameter(
        0.8, "speed per error of distance", unit="1/s", low=0.0, high=5.0
    )
    turn_gain: float = parameter(2.0, "turn rate per bearing", unit="1/s", low=0.0, high=10.0)
    feed_forward: float = parameter(
        0.0, "part of the target's own velocity that commands take over", low=0.0, high=1.0
    )
    max_linear: float = parameter(0.6, "fastest drive", unit="m/s", low=0.0, high=5.0)
    max_angular: float = parameter(1.0, "fastest turn", unit="rad/s", low=0.0, high=5.0)
    ease: float = parameter(
        0.2, "time in which commands come near what is wanted; a stop is at once",
        unit="s", low=0.0, high=2.0,
    )  # fmt: skip
    timeout: float = parameter(
        0.3, "without news of the target for this long it stops", unit="s", low=0.05, high=0.45
    )
    drive_on: float = parameter(
        2.0, "a hidden target's place is predicted, and driven to, for this long; 0: it stops",
        unit="s", low=0.0, high=5.0,
    )  # fmt: skip
    rate: float = parameter(20.0, "commands a second", unit="1/s", low=10.0, high=200.0)
    image_width: float = parameter(
        0.0, "of the images, where there is no ~/bearing but only ~/pose; 0: wait for a bearing",
        unit="px", low=0.0, high=20000.0,
    )  # fmt: skip
    field_of_view: float = parameter(
        1.08, "of the camera across, used with image_width", unit="rad", low=0.1, high=3.0
    )

    def __post_init__(self) -> None:
        check_parameters(self)


class Follower:
    """Turns towards the target and keeps a distance; stands still when in doubt.

    It moves only while fresh statuses say TRACKING or COASTING. Where the target's place is not
    known, as while it is hidden, it goes by where the target should be, slower and slower: who
    waits in front of a column sees the target come out far away, or never. All times are s of one
    monotonic clock.
    """

    def __init__(self, config: FollowerConfig) -> None:
        self.config = config
        self._state = State.LOST
        self._heard = -math.inf
        self._bearing = 0.0
        self._aimed = -math.inf
        self._placed = -math.inf
        self._reckoning = Reckoning()
        self._ahead = FeedForward(config.timeout)
        self._told: tuple[float, float, float] | None = None  # s, m/s, rad/s

    def on_status(self, state: State, now: float) -> None:
        """Take the state of the track."""
        self._state, self._heard = state, now

    def on_bearing(self, x: float, z: float, now: float) -> None:
        """Take a ray's part to the right and forward."""
        self._bearing, self._aimed = math.atan2(x, z), now

    def on_pixel(self, x: float, now: float) -> None:
        """Take the column of the target's centre, px, as a bearing of a camera without lens."""
        if self.config.image_width > 0:
            half = self.config.image_width / 2
            slope = math.tan(self.config.field_of_view / 2)
            self.on_bearing((x - half) / half * slope, 1.0, now)

    def on_place(self, x: float, z: float, now: float) -> None:
        """Take where the target is, m to the right and forward."""
        self._placed = now
        self._reckoning.seen(x, z, now)
        self._ahead.on_place(x, z)

    def on_velocity(self, x: float, z: float, now: float) -> None:
        """Take the target's velocity relative to the camera, m/s to the right and forward."""
        self._ahead.on_velocity(x, z, now)

    def command(self, now: float) -> tuple[float, float]:
        """(m/s forward, rad/s to the left) from now on; (0, 0) when in doubt."""
        in_doubt = now - self._heard > self.config.timeout or self._state not in (
            State.TRACKING,
            State.COASTING,
        )
        linear, angular = (0.0, 0.0) if in_doubt else self._eased(*self._wanted(now), now)
        self._told = now, linear, angular
        self._reckoning.told(linear, angular, now)
        self._ahead.told(linear, angular)
        return linear, angular

    def _eased(self, linear: float, angular: float, now: float) -> tuple[float, float]:
        """What is wanted, or a part of the way there since the last command; a stop in full.

        A target that comes out from behind something is not where it was thought to be: a robot
        that jumps to the new command shakes its camera.
        """
        if self._told is None or self.config.ease == 0:
            return linear, angular
        told, *before = self._told
        share = -math.expm1(-max(now - told, 0.0) / self.config.ease)
        wanted = zip((linear, angular), before, strict=True)
        eased = [last + share * (to - last) if to else 0.0 for to, last in wanted]
        return eased[0], eased[1]

    def _wanted(self, now: float) -> tuple[float, float]:
        """The command without regard to those before."""
        config, unknown_for = self.config, now - self._placed
        aimed = now - self._aimed <= config.timeout
        bearing = self._bearing if aimed else 0.0
        if unknown_for > LONGEST_PREDICTION:
            return 0.0, self._turn(bearing)
        x, z = self._reckoning.predicted(now)
        if self._state is State.COASTING or unknown_for <= config.timeout:
            bearing = math.atan2(x, z)
        part = config.feed_forward if self._ahead.known(now) else 0.0
        outwards, around = (part * rate for rate in self._ahead.rates(x, z, now))
        # What is driven ahead need not be caught up with: small gains pass on less noise.
        gain = 1 - EASED * part
        speed = self._speed(math.hypot(x, z), bearing, unknown_for, gain, outwards)
        return speed, self._turn(bearing, gain, around)

    def _turn(self, bearing: float, gain: float = 1.0, around: float = 0.0) -> float:
        turn = around - gain * self.config.turn_gain * bearing
        return _limited(turn, self.config.max_angular)

    def _speed(
        self, away: float, bearing: float, unknown_for: float, gain: float, outwards: float
    ) -> float:
        """The speed to a target so far away (m), whose place has been unknown for so long (s)."""
        config = self.config
        # Turn first, then drive: a target at the side is no place to drive to.
        ahead = max(math.cos(bearing), 0.0)
        wanted = gain * config.drive_gain * (away - config.distance) + outwards
        speed = _limited(wanted * ahead, config.max_linear)
        if unknown_for <= config.timeout:
            return speed
        if unknown_for >= config.drive_on:
            return 0.0
        return speed * (1 - unknown_for / config.drive_on)


def _limited(value: float, most: float) -> float:
    return min(max(value, -most), most) if math.isfinite(value) else 0.0
