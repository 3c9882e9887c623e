# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is published of one frame: estimate, status, debug image."""

from __future__ import annotations

import time
from dataclasses import replace

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped

from het_ros.ros.debug_image import debug_message, drawn
from het_ros.ros.detections import detections_message
from het_ros.ros.diagnostics import Health
from het_ros.ros.images import ImageError
from het_ros.ros.messages import polygon_from_box, pose_from_estimate, twist_from_estimate
from het_ros.ros.outcome import Outcome
from het_ros.ros.outputs import Outputs
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.space import Space
from het_ros.ros.stamps import SECOND
from het_ros.ros.status import Status, status_message
from het_ros.ros.target_motion import TargetMotion, twist_in_scene
from het_ros.tracking.estimate import State

SEEN = (State.TRACKING, State.COASTING)


class Answers:
    """Turns outcomes into messages.

    Attributes:
        settings: the node's parameters.
        health: latencies and rate of what was published.

    Args:
        name: the node's full name.
        outputs: where the messages go.
        space: makes bearing and place of a box.
    """

    def __init__(self, name: str, outputs: Outputs, space: Space, settings: NodeConfig) -> None:
        self.settings = settings
        self.health = Health()
        self._name = name
        self._outputs = outputs
        self._space = space
        self._drawn = 0
        self._motion = TargetMotion()

    def publish(self, outcome: Outcome) -> None:
        """Publish an outcome; in LOST and without a track the status alone."""
        if outcome.state in SEEN:
            self._publish_estimate(outcome)
        self._outputs.send("status", lambda: self._status(outcome))
        self.health.processed(time.monotonic() - outcome.frame.arrival)
        self._draw(outcome)

    def _publish_estimate(self, outcome: Outcome) -> None:
        header, estimate, pixels = outcome.frame.header, outcome.estimate, outcome.pixels
        if estimate is None or pixels is None:
            return
        now, size, track = estimate.box, (pixels.shape[1], pixels.shape[0]), outcome.track
        velocity, ahead = estimate.velocity, self.settings.latency_ahead
        if ahead:
            estimate = replace(
                estimate.predict(ahead), velocity=velocity, patches=estimate.patches
            )
        box = estimate.box
        send = self._outputs.send
        send("box", lambda: polygon_from_box(box, header))
        send("pose", lambda: pose_from_estimate(estimate, header))
        send("velocity", lambda: twist_from_estimate(estimate, header))
        send("velocity_in_scene", lambda: twist_in_scene(estimate, header))
        send("bearing", lambda: self._space.bearing(box, size, header))
        # The depth is looked at whoever listens: it may tell that the box holds another thing.
        # While COASTING it is that of what hides the target.
        if outcome.state is State.TRACKING:
            self._publish_place(self._space.pose(now, size, header, track), track)
        if "detections" in self._outputs:
            send("detections", lambda: detections_message(estimate, track, header))

    def _publish_place(self, place: PoseStamped | None, track: int) -> None:
        """Publish a track's place in metres, as measured and filtered."""
        if place is None:
            return
        motion, ahead = self._motion, self.settings.latency_ahead
        motion.take(place, track)
        self._outputs.send("target_pose", lambda: motion.ahead(place, ahead))
        self._outputs.send("target_pose_cov", lambda: motion.pose(place.header, ahead))
        self._outputs.send("target_velocity", lambda: motion.velocity(place.header))

    def _status(self, outcome: Outcome) -> DiagnosticArray:
        status = Status(
            state=outcome.state,
            score=0.0 if outcome.estimate is None else float(outcome.estimate.score),
            latency=time.monotonic() - outcome.frame.arrival,
            age=outcome.age,
            reason=outcome.reason,
        )
        return status_message(status, self._name, outcome.frame.header)

    def _draw(self, outcome: Outcome) -> None:
        """Draw the debug image for subscribers, ``debug_rate`` times a second at most."""
        stamp = outcome.frame.stamp
        early = 0 <= stamp - self._drawn < SECOND / self.settings.debug_rate
        if early or not self._outputs.heard("debug_image"):
            return
        self._drawn = stamp
        pixels = outcome.pixels
        if pixels is None:
            try:
                pixels = outcome.frame.pixels(self.settings.reading)
            except ImageError:
                return
        image = drawn(pixels, outcome.estimate, outcome.state, outcome.reason)
        self._outputs.send("debug_image", lambda: debug_message(image, outcome.frame.header))
