# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""From frames and boxes in whatever order they come to one estimate a frame.

Holds what lies between the topics and the track: the order of stamps, the ring of recent frames,
the box that waits for its image or came late, and the frames still to be caught up with. Calls
nothing of rclpy, so that every order of events can be tested by hand.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from std_msgs.msg import Header

from het_ros.ros.backlog import Backlog
from het_ros.ros.box_requests import BoxRequests, Request
from het_ros.ros.frames import Frame, FrameRing
from het_ros.ros.hints import Hints, Ration
from het_ros.ros.images import ENCODINGS, ImageError, Pixels
from het_ros.ros.messages import BoxError
from het_ros.ros.outcome import Outcome
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.session import TrackingSession
from het_ros.ros.stamps import Order, StampGate
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State
from het_ros.tracking.tracker import Witness

FrameWitness = Callable[[Box, tuple[int, int], Header, int], bool]
Patience = Callable[[Frame], float]
Suggest = Callable[[Box, float, int], Sequence[Box]]


class Pursuit:
    """One target through a stream of frames.

    Feed it with :meth:`on_frame` and :meth:`on_box`, and call :meth:`step` while :attr:`busy`.

    Args:
        config: the tracker's parameters.
        settings: the node's.
        logger: of the node.
        witness: another sensor, asked whether a track's target may be in a box of an image of
            that size (width, height) px and header.
        patience: s that a frame is to wait until that sensor has seen it too.
        suggest: where else to look for a target that was last thought to be in a box and has not
            been seen for so long (s), in the image with a stamp (ns).

    Attributes:
        session: the track.
        counts: frames by what became of them: processed, duplicate, late, unreadable, skipped.
        track: number of the track, 1 for the first; 0 before it.
    """

    def __init__(
        self,
        config: TrackerConfig,
        settings: NodeConfig,
        logger: Any,
        witness: FrameWitness | None = None,
        patience: Patience = lambda frame: 0.0,
        suggest: Suggest = lambda box, hidden, stamp: (),
    ) -> None:
        self.session = TrackingSession(config, settings.max_gap, settings.tracker)
        self.counts: Counter[str] = Counter()
        self.track = 0
        self.settings = settings
        self._logger = logger
        self._witness = witness
        self._patience = patience
        self._suggest = suggest
        self._hints = Hints(logger)
        self._starts, self._refusals, self._ends = Ration(), Ration(), Ration()
        self._gate = StampGate(settings.jump_back)
        self._ring = FrameRing(settings.ring_seconds, settings.ring_megabytes, settings.reading)
        self._backlog = Backlog()
        self._requests = BoxRequests(self._hints)
        self._published = -1
        self._readable: set[tuple[str, int, int]] = set()

    @property
    def busy(self) -> bool:
        """Whether frames wait for :meth:`step`."""
        return len(self._backlog) > 0

    @property
    def newest(self) -> Frame | None:
        """The newest frame; None before the first."""
        return self._ring.newest

    @property
    def left(self) -> float:
        """How much longer the next frame waits for another sensor, s; 0 without a track."""
        needed = self.session.running or self._requests.waiting is not None
        return self._patience(self._backlog.next) if self.busy and needed else 0.0

    def configure(self, config: TrackerConfig, settings: NodeConfig) -> None:
        """Take new parameters: the node's at once, the tracker's with the next box."""
        self.settings = settings
        self.session.config, self.session.max_gap = config, settings.max_gap
        self.session.tracker = settings.tracker
        self._gate.jump_back = settings.jump_back
        self._ring.seconds, self._ring.megabytes = settings.ring_seconds, settings.ring_megabytes

    def drop(self, reason: str) -> None:
        """End the track and forget boxes that wait: IDLE."""
        self.session.drop(reason)
        self._requests.drop()

    def on_frame(self, frame: Frame) -> None:
        """Take a frame in, unless it came already or too late."""
        order = self._gate.take(frame.stamp)
        if order in (Order.DUPLICATE, Order.LATE):
            self.counts[order.value] += 1
            return
        if order is Order.JUMP_BACK:
            self._jump_back()
        self._ring.add(frame)
        self._backlog.add(frame)

    def on_box(self, box: Box, stamp: int) -> Outcome | None:
        """Start on the image that the stamp (ns) names: a past one, the newest, one to come.

        Returns:
            The image's outcome, or None where the box waits for its image. After a past image
            it is :attr:`busy` with those since.

        Raises:
            BoxError: the box does not fit its image, which is not kept any more or never came;
                the track that runs goes on.
        """
        request, newest = Request(box, stamp), self._ring.newest
        if newest is None or stamp > newest.stamp:
            self._requests.wait(request, newest, self.settings.max_gap)
            return None
        frame = self._requests.image_of(request, self._ring, self.settings.box_tolerance)
        try:
            pixels = frame.pixels(self.settings.reading)
        except ImageError as error:
            raise BoxError(f"its image cannot be read: {error}") from error
        estimate = self._start(frame, pixels, box)
        self._requests.waiting = None
        self._backlog.replace(self._ring.since(frame))
        return self._outcome(frame, pixels, estimate)

    def step(self, hurry: bool = False) -> Outcome | None:
        """Process the next frame; None where it could not be read.

        Args:
            hurry: leave frames out where they come in faster than they are processed.
        """
        frame = self._backlog.take()
        begin = time.monotonic()
        try:
            pixels = self._pixels(frame)
        except ImageError as error:
            self._leave_out(frame, error)
            return None
        estimate = None
        if pixels is not None:
            estimate = self._started(frame, pixels) or self._followed(frame, pixels)
        self.counts["processed"] += 1
        # Frames that wait for another sensor are not behind for want of time.
        if hurry and self.busy and not self.left:
            self.counts["skipped"] += self._backlog.skip(time.monotonic() - begin)
        return self._outcome(frame, pixels, estimate)

    def refuse(self, why: object) -> None:
        """Log that a box was refused, and that nothing else has changed."""
        goes_on = "; the running track goes on" if self.session.running else ""
        if line := self._refusals.line(f"init box refused: {why}{goes_on}"):
            self._logger.warning(line)

    def _started(self, frame: Frame, pixels: Pixels) -> Estimate | None:
        """Start the box that waits for this frame; None where none does or it is refused."""
        try:
            box = self._requests.due(frame, self.settings.box_tolerance)
            return None if box is None else self._start(frame, pixels, box)
        except BoxError as error:
            self.refuse(error)
            return None

    def _start(self, frame: Frame, pixels: Pixels, box: Box) -> Estimate:
        """Start a track; raises BoxError, whatever the reason, with the old track as it was."""
        try:
            estimate = self.session.start(pixels, frame.stamp, box, frame.header.frame_id)
        except Exception as error:  # a box from outside must not end the node
            wrong = str(error) if isinstance(error, ValueError) else f"internal error: {error!r}"
            raise BoxError(wrong) from error
        self.track += 1
        if line := self._starts.line(f"tracking started on {box}"):
            self._logger.info(line)
        return estimate

    def _followed(self, frame: Frame, pixels: Pixels) -> Estimate | None:
        """Follow the track into this frame; a fault inside ends the track, not the node."""
        before = self.session.state
        try:
            estimate = self.session.follow(
                pixels,
                frame.stamp,
                frame.header.frame_id,
                self._witness_of(frame, pixels),
                self._candidates(frame),
            )
        except Exception as error:  # a robot must hear LOST, whatever went wrong in here
            self._logger.error(f"the tracker failed on an image: {error!r}")
            self.session.lose(f"internal error: {error!r}")
            return None
        if self.session.state is State.LOST and before is not State.LOST:
            self._warn_of_end(f"target lost: {self.session.reason}")
        return estimate

    def _witness_of(self, frame: Frame, pixels: Pixels) -> Witness | None:
        """Asks the other sensor of this frame and track."""
        ask = self._witness
        if ask is None:
            return None
        size = pixels.shape[1], pixels.shape[0]
        return lambda box: ask(box, size, frame.header, self.track)

    def _candidates(self, frame: Frame) -> Sequence[Box]:
        """Where a target that was not seen in the last frame is to be looked for first."""
        session = self.session
        if session.box is None or session.state is State.TRACKING:
            return ()
        return self._suggest(session.box, session.age, frame.stamp)

    def _pixels(self, frame: Frame) -> Pixels | None:
        """The frame's image; None where no one needs it and its like could be read before."""
        message = frame.message
        kind = (
            getattr(message, "encoding", "compressed"),
            getattr(message, "width", 0),
            getattr(message, "height", 0),
        )
        needed = self._requests.waiting is not None or self.session.running
        if not needed and kind in self._readable:
            return None
        pixels = frame.pixels(self.settings.reading)
        if len(self._readable) < 100:
            self._readable.add(kind)
        return pixels

    def _leave_out(self, frame: Frame, error: ImageError) -> None:
        self.counts["unreadable"] += 1
        self._ring.remove(frame)
        encoding = getattr(frame.message, "encoding", "compressed")
        # Names that senders make up are one kind of fault: each of its own would be kept for ever.
        kind = encoding if encoding in ENCODINGS else "unknown"
        self._hints.once(f"image {kind}", f"image refused: {error}")

    def _warn_of_end(self, text: str) -> None:
        """Log why a track ended; not every time where stamps or cameras take turns."""
        if line := self._ends.line(text):
            self._logger.warning(line)

    def _jump_back(self) -> None:
        """Time went back: what was learnt of motion does not hold, and old frames are void."""
        self._warn_of_end("the stamps jumped back (a bag in a loop?): the track is reset")
        self.session.drop("time jumped back")
        self._requests.jump_back()
        self._ring.clear()
        self._backlog.replace(())
        self._published = -1

    def _outcome(self, frame: Frame, pixels: Pixels | None, estimate: Estimate | None) -> Outcome:
        published = frame.stamp >= self._published
        self._published = max(self._published, frame.stamp)
        session = self.session
        return Outcome(
            frame,
            pixels,
            estimate,
            published,
            self.track,
            session.state,
            session.reason,
            session.age,
        )
