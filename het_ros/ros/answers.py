# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is published of one frame: estimate, status, debug image."""

from __future__ import annotations

import time
from collections import deque

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Float32, Header

from het_ros.ros.debug_image import debug_message, drawn
from het_ros.ros.detections import detections_message
from het_ros.ros.diagnostics import Health
from het_ros.ros.frames import Frame
from het_ros.ros.images import ImageError, Pixels
from het_ros.ros.messages import (
    header_of,
    polygon_from_box,
    pose_from_estimate,
    stamp_ns,
    twist_from_estimate,
)
from het_ros.ros.outcome import Outcome
from het_ros.ros.outputs import Outputs
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.space import Space
from het_ros.ros.stamps import SECOND
from het_ros.ros.status import Status, status_message
from het_ros.ros.target_motion import TargetMotion, twist_in_scene
from het_ros.tracking.box import Box
from het_ros.tracking.estimate import Estimate, State

SEEN = (State.TRACKING, State.COASTING)
LARGEST_STAMP = (2**31 - 1) * SECOND  # ns that a header holds
MOST_OWED = 8  # frames whose depth may still come


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
        self._owed: deque[tuple[Box, tuple[int, int], Header, int]] = deque(maxlen=MOST_OWED)
        self._motion = TargetMotion()

    def publish(self, outcome: Outcome) -> None:
        """Publish an outcome; in LOST and without a track status and score alone."""
        if outcome.state in SEEN:
            self._publish_estimate(outcome)
        frame, estimate = outcome.frame, outcome.estimate
        status = Status(
            state=outcome.state,
            score=0.0 if estimate is None else float(estimate.score),
            latency=time.monotonic() - frame.arrival,
            age=outcome.age,
            reason=outcome.reason,
        )
        self._tell(status, frame.header)
        self.health.processed(time.monotonic() - frame.arrival)
        self._draw(frame, frame.header, status, outcome.pixels, estimate)

    def publish_silence(self, status: Status, newest: Frame | None, now: Time) -> None:
        """Publish a status of its own while no image comes, and the newest image with it.

        Its stamp is that of the newest image and the time since that came in, so that it follows
        the camera's clock; ``now`` where no image came at all.
        """
        header = Header(stamp=now)
        if newest is not None:
            passed = round((time.monotonic() - newest.arrival) * SECOND)
            stamp = min(stamp_ns(newest.header) + passed, LARGEST_STAMP)
            header = header_of(stamp, newest.header.frame_id)
        self._tell(status, header)
        if newest is not None:
            self._draw(newest, header, status)

    def _tell(self, status: Status, header: Header) -> None:
        self._outputs.send("status", lambda: status_message(status, self._name, header))
        self._outputs.send("score", lambda: Float32(data=status.score))

    def _publish_estimate(self, outcome: Outcome) -> None:
        header, estimate, pixels = outcome.frame.header, outcome.estimate, outcome.pixels
        if estimate is None or pixels is None:
            return
        size, track = (pixels.shape[1], pixels.shape[0]), outcome.track
        ahead = self.settings.latency_ahead
        later = estimate.predict(ahead) if ahead else estimate
        box = later.box
        send = self._outputs.send
        send("box", lambda: polygon_from_box(box, header))
        send("pose", lambda: pose_from_estimate(later, header))
        send("velocity", lambda: twist_from_estimate(estimate, header))
        send("velocity_in_scene", lambda: twist_in_scene(estimate, header))
        send("bearing", lambda: self._space.bearing(box, size, header))
        # The depth is looked at whoever listens: it may tell that the box holds another thing.
        # While COASTING it is that of what hides the target.
        if outcome.state is State.TRACKING:
            self._place(estimate.box, size, header, track)
        if "detections" in self._outputs:
            send("detections", lambda: detections_message(later, track, header))

    def place_late(self) -> None:
        """Publish where the target was in frames whose depth came after they were answered."""
        while self._owed and self._space.seen(self._owed[0][2]):
            owed = self._owed.popleft()
            place = self._space.pose(*owed)
            if place is not None:
                self._publish_place(place, owed[-1])

    def _publish_place(self, place: PoseStamped, track: int) -> None:
        """Publish a track's place in metres, as measured and filtered."""
        motion, ahead = self._motion, self.settings.latency_ahead
        motion.take(place, track)
        self._outputs.send("target_pose", lambda: motion.ahead(place, ahead))
        self._outputs.send("target_pose_cov", lambda: motion.pose(place.header, ahead))
        self._outputs.send("target_velocity", lambda: motion.velocity(place.header))

    def _place(self, box: Box, size: tuple[int, int], header: Header, track: int) -> None:
        """Publish where the target is, or keep in mind to do so when its depth comes."""
        place = self._space.pose(box, size, header, track)
        if place is not None:
            self._owed.clear()  # no place comes after that of a later frame
            self._publish_place(place, track)
        elif not self._space.seen(header):
            self._owed.append((box, size, header, track))

    def _draw(
        self,
        frame: Frame,
        header: Header,
        status: Status,
        pixels: Pixels | None = None,
        estimate: Estimate | None = None,
    ) -> None:
        """Draw the debug image for subscribers, ``debug_rate`` times a second at most."""
        stamp = stamp_ns(header) or frame.stamp
        early = 0 <= stamp - self._drawn < SECOND / self.settings.debug_rate
        if early or not self._outputs.heard("debug_image"):
            return
        self._drawn = stamp
        if pixels is None:
            try:
                pixels = frame.pixels(self.settings.reading)
            except ImageError:
                return
        image = drawn(pixels, estimate, status.state, status.reason)
        self._outputs.send("debug_image", lambda: debug_message(image, header))
