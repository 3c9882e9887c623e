"""From frames and boxes in whatever order they come to one estimate a frame.

Holds what lies between the topics and the track: the order of stamps, the ring of recent frames,
the box that waits for its image or came late, and the frames still to be caught up with. Calls
nothing of rclpy, so that every order of events can be tested by hand.
"""

from __future__ import annotations

import time
from collections import Counter, deque
from dataclasses import dataclass

from het_ros.ros.frames import Frame, FrameRing
from het_ros.ros.hints import Hints
from het_ros.ros.images import ImageError, Pixels
from het_ros.ros.messages import BoxError
from het_ros.ros.parameters import NodeConfig
from het_ros.ros.session import TrackingSession
from het_ros.ros.stamps import SECOND, Order, StampGate
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State

MEGA = 1_000_000


@dataclass(frozen=True)
class Request:
    """A box and the stamp (ns) of the image it was drawn on; 0 takes any image."""

    box: Box
    stamp: int


@dataclass(frozen=True)
class Outcome:
    """One processed frame.

    Attributes:
        frame: the frame.
        pixels: its image, or None where nothing needed it.
        estimate: of this frame, or None without a track.
        published: whether it is to be published: not while it is older than what was.
        track: number of the track.
        state, reason, age: of the track after this frame, see :class:`TrackingSession`.
    """

    frame: Frame
    pixels: Pixels | None
    estimate: Estimate | None
    published: bool
    track: int
    state: State
    reason: str
    age: float


class Pursuit:
    """One target through a stream of frames.

    Feed it with :meth:`on_frame` and :meth:`on_box`, and call :meth:`step` while :attr:`busy`.

    Attributes:
        session: the track.
        counts: frames by what became of them: processed, duplicate, late, unreadable, skipped.
        track: number of the track, 1 for the first; 0 before it.
    """

    def __init__(self, config: TrackerConfig, settings: NodeConfig, logger) -> None:
        self.session = TrackingSession(config, settings.max_gap)
        self.counts: Counter[str] = Counter()
        self.track = 0
        self.settings = settings
        self._logger = logger
        self._hints = Hints(logger)
        self._gate = StampGate(settings.jump_back)
        self._ring = FrameRing(
            settings.ring_seconds, settings.ring_megabytes, settings.white_level
        )
        self._backlog: deque[Frame] = deque()
        self._request: Request | None = None
        self._void: Request | None = None
        self._published = -1
        self._step_time = 0.0
        self._readable: set[tuple[str, int, int]] = set()

    @property
    def busy(self) -> bool:
        """Whether frames wait for :meth:`step`."""
        return bool(self._backlog)

    @property
    def started(self) -> bool:
        """Whether any frame has come in."""
        return self._gate.newest is not None

    def configure(self, config: TrackerConfig, settings: NodeConfig) -> None:
        """Take new parameters: the node's at once, the tracker's with the next box."""
        self.settings = settings
        self.session.config, self.session.max_gap = config, settings.max_gap
        self._gate.jump_back = settings.jump_back
        self._ring.seconds, self._ring.megabytes = settings.ring_seconds, settings.ring_megabytes

    def drop(self, reason: str) -> None:
        """End the track and forget boxes that wait: IDLE."""
        self.session.drop(reason)
        self._request = self._void = None

    def on_frame(self, frame: Frame) -> None:
        """Take a frame in, unless it came already or too late."""
        order = self._gate.take(frame.stamp)
        if order in (Order.DUPLICATE, Order.LATE):
            self.counts[order.value] += 1
            return
        if order is Order.JUMP_BACK:
            self._jump_back()
        self._ring.add(frame)
        self._backlog.append(frame)

    def on_box(self, box: Box, stamp: int) -> Outcome | None:
        """Start on the image that the stamp (ns) names: a past one, the newest, one to come.

        Returns:
            The image's outcome, or None where the box waits for its image. After a past image
            the pursuit is :attr:`busy` with those since.

        Raises:
            BoxError: the box does not fit its image, which is not kept any more or never came;
                the track that runs goes on.
        """
        newest = self._ring.newest
        if newest is None or stamp > newest.stamp:
            self._wait(Request(box, stamp), newest)
            return None
        frame = newest if stamp == 0 else self._frame_of(box, stamp, newest)
        try:
            pixels = frame.pixels(self.settings.white_level)
        except ImageError as error:
            raise BoxError(f"its image cannot be read: {error}") from error
        estimate = self._start(frame, pixels, box)
        self._request = None
        self._backlog = deque(self._ring.since(frame))
        return self._outcome(frame, pixels, estimate)

    def step(self, hurry: bool = False) -> Outcome | None:
        """Process the next frame; None where it could not be read.

        Args:
            hurry: leave frames out where they come in faster than they are processed.
        """
        frame = self._backlog.popleft()
        begin = time.monotonic()
        try:
            pixels = self._pixels(frame)
        except ImageError as error:
            self._leave_out(frame, error)
            return None
        estimate = self._started(frame, pixels) or self._followed(frame, pixels)
        self.counts["processed"] += 1
        if hurry and self._backlog:
            self._skip(time.monotonic() - begin)
        return self._outcome(frame, pixels, estimate)

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

    # Boxes ----------------------------------------------------------------------------------

    def _wait(self, request: Request, newest: Frame | None) -> None:
        self._request = request
        if newest is None:
            self._hints.once(
                "early box", "a box came before any image: it starts on the first one"
            )
        elif request.stamp - newest.stamp > self.settings.max_gap * SECOND:
            self._hints.once(
                "box ahead",
                f"a box is stamped {(request.stamp - newest.stamp) / SECOND:.2f} s after the "
                "newest image and waits for its own: do both clocks agree?",
            )

    def _frame_of(self, box: Box, stamp: int, newest: Frame) -> Frame:
        nearest = self._ring.nearest(stamp)
        assert nearest is not None
        off = abs(nearest.stamp - stamp) / SECOND
        if off <= self.settings.box_tolerance:
            return nearest
        self._void = Request(box, stamp)  # right after all where time jumps back to it
        age = (newest.stamp - stamp) / SECOND
        if age > self._ring.span:
            raise BoxError(
                f"it was drawn on an image {age:.2f} s older than the newest, and images are kept "
                f"for {self._ring.span:.2f} s: send boxes sooner, or raise ring_seconds "
                "and ring_megabytes"
            )
        raise BoxError(
            f"no image came within {self.settings.box_tolerance:g} s of its stamp, "
            f"the nearest is {off:.2f} s away"
        )

    def _started(self, frame: Frame, pixels: Pixels | None) -> Estimate | None:
        """Start the box that waits for this frame; None where none does or it is refused."""
        request = self._request
        if request is None or request.stamp > frame.stamp or pixels is None:
            return None
        self._request = None
        late = (frame.stamp - request.stamp) / SECOND if request.stamp else 0.0
        try:
            if late > self.settings.box_tolerance:
                raise BoxError(f"its image did not come, the next one is {late:.2f} s later")
            return self._start(frame, pixels, request.box)
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
        self._logger.info(f"tracking started on {box}")
        return estimate

    def refuse(self, why: object) -> None:
        """Log that a box was refused, and that nothing else has changed."""
        goes_on = "; the running track goes on" if self.session.running else ""
        self._logger.warning(f"init box refused: {why}{goes_on}")

    # Frames ---------------------------------------------------------------------------------

    def _pixels(self, frame: Frame) -> Pixels | None:
        """The frame's image; None where no one needs it and its like could be read before."""
        message = frame.message
        kind = (
            getattr(message, "encoding", "compressed"),
            getattr(message, "width", 0),
            getattr(message, "height", 0),
        )
        if self._request is None and not self.session.running and kind in self._readable:
            return None
        pixels = frame.pixels(self.settings.white_level)
        height, width = pixels.shape[:2]
        if width * height > self.settings.max_megapixels * MEGA:
            raise ImageError(
                f"{width} x {height} px are more than max_megapixels "
                f"({self.settings.max_megapixels:g}): send smaller images, or raise it"
            )
        if len(self._readable) < 100:
            self._readable.add(kind)
        return pixels

    def _leave_out(self, frame: Frame, error: ImageError) -> None:
        self.counts["unreadable"] += 1
        self._ring.remove(frame)
        encoding = getattr(frame.message, "encoding", "compressed")
        self._hints.once(f"image {encoding}", f"image refused: {error}")

    def _followed(self, frame: Frame, pixels: Pixels | None) -> Estimate | None:
        """Follow the track into this frame; a fault inside ends the track, not the node."""
        if pixels is None:
            return None
        before = self.session.state
        try:
            estimate = self.session.follow(pixels, frame.stamp, frame.header.frame_id)
        except Exception as error:  # a robot must hear LOST, whatever went wrong in here
            self._logger.error(f"the tracker failed on an image: {error!r}")
            self.session.lose(f"internal error: {error!r}")
            return None
        if self.session.state is State.LOST and before is not State.LOST:
            self._logger.warning(f"target lost: {self.session.reason}")
        return estimate

    def _skip(self, step_time: float) -> None:
        """Leave out so many frames that the backlog shrinks, but never the newest.

        A step of p s lets p / T new frames in (T: their interval); stepping over 2 p / T halves
        at least what is left behind.
        """
        interval = self._backlog[-1].stamp - self._backlog[0].stamp
        if len(self._backlog) < 2 or interval <= 0:
            return
        interval /= (len(self._backlog) - 1) * SECOND
        for _ in range(min(int(2 * step_time / interval), len(self._backlog) - 1)):
            self._backlog.popleft()
            self.counts["skipped"] += 1

    def _jump_back(self) -> None:
        """Time went back: what was learnt of motion does not hold, and old frames are void."""
        self._logger.warning("the stamps jumped back (a bag in a loop?): the track is reset")
        again = self._void
        self.drop("time jumped back")
        self._request = again
        self._ring.clear()
        self._backlog.clear()
        self._published = -1
