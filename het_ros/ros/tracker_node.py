"""The node ``tracker``: one box on a camera stream in, box, velocity and status out."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import (
    PolygonStamped,
    PoseWithCovarianceStamped,
    TwistWithCovarianceStamped,
)
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import ParameterException
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import CompressedImage, Image, RegionOfInterest
from std_msgs.msg import Header
from std_srvs.srv import SetBool, Trigger

from het_ros.ros.hints import Hints
from het_ros.ros.images import ImageError, Pixels, array_of
from het_ros.ros.messages import (
    BoxError,
    box_from_polygon,
    box_from_roi,
    polygon_from_box,
    pose_from_estimate,
    stamp_ns,
    twist_from_estimate,
)
from het_ros.ros.parameters import NodeConfig, declare, read
from het_ros.ros.session import TrackingSession
from het_ros.ros.stamps import SECOND, Order, StampGate
from het_ros.ros.status import Status, status_message
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import Estimate, State

ImageMessage = Image | CompressedImage
Tap = Callable[[str, Any], None]

# Depth 1: with a deeper queue a busy node works on old images, and latency grows by the depth.
NEWEST_ONLY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
RELIABLE = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)
OUTPUTS = {
    "box": PolygonStamped,
    "pose": PoseWithCovarianceStamped,
    "velocity": TwistWithCovarianceStamped,
    "status": DiagnosticArray,
}


@dataclass(frozen=True)
class Frame:
    """One image as it came in: its message, its stamp (ns) and when it arrived (s, monotonic)."""

    message: ImageMessage
    stamp: int
    arrival: float

    @property
    def header(self) -> Header:
        """The image's header, which every output of this frame carries."""
        return self.message.header


@dataclass(frozen=True)
class Request:
    """A box that waits for the image it was drawn on; stamp 0 takes any image."""

    box: Box
    stamp: int


class TrackerNode(LifecycleNode):
    """Follows one target; all the tracking is in :class:`TrackingSession`.

    With ``autostart`` (the default) the node is active when its constructor returns. Without an
    executor it can be driven by hand, deterministically and in one thread: call
    :meth:`on_init_box` and :meth:`on_image` with messages and take what it publishes from
    ``tap``. Deactivating keeps the track, cleaning up drops it; a pause counts as a gap between
    images, so after more than ``max_gap`` the track is LOST.

    Args:
        name: node name, first part of the output topics.
        tap: called as ``tap(topic, message)`` for everything published, subscribers or not;
            topic is "box", "pose", "velocity" or "status".
        config: the tracker's defaults, under the parameters that are set.
        **options: of rclpy's Node (context, namespace, parameter_overrides, cli_args...).
    """

    def __init__(
        self,
        name: str = "tracker",
        *,
        tap: Tap | None = None,
        config: TrackerConfig | None = None,
        **options: Any,
    ) -> None:
        super().__init__(name, **options)
        self._tap = tap
        self._hints = Hints(self.get_logger())
        declare(self, NodeConfig())
        declare(self, config or TrackerConfig())
        self._settings = read(self, NodeConfig)
        self._session = TrackingSession(read(self, TrackerConfig), self._settings.max_gap)
        self._gate = StampGate(self._settings.jump_back)
        self._newest: Frame | None = None
        self._request: Request | None = None
        self._active = False
        self._enabled = True
        self._entities: list[tuple[Callable[[Any], Any], Any]] = []
        self._outputs: dict[str, Any] = {}
        if self._settings.autostart:
            self.trigger_configure()
            self.trigger_activate()

    @property
    def state(self) -> State:
        """Where the track stands."""
        return self._session.state

    @property
    def reason(self) -> str:
        """Why :attr:`state` is not TRACKING; empty while it is."""
        return self._session.reason

    # Lifecycle ------------------------------------------------------------------------------

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the outputs and the services, on a stream that nothing is known of."""
        self._gate = StampGate(self._settings.jump_back)
        for topic, kind in OUTPUTS.items():
            self._outputs[topic] = self.create_publisher(
                kind,
                f"~/{topic}",
                RELIABLE,
                qos_overriding_options=QoSOverridingOptions.with_default_policies(),
            )
        self._reset_service = self.create_service(Trigger, "~/reset", self._on_reset)
        self._enable_service = self.create_service(SetBool, "~/enable", self._on_enable)
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Subscribe to the inputs."""
        compressed = self._settings.image_transport == "compressed"
        topic = self.resolve_topic_name("image") + ("/compressed" if compressed else "")
        kind = CompressedImage if compressed else Image
        self._image_input = self._subscribe(kind, topic, self.on_image, NEWEST_ONLY)
        self._subscribe(PolygonStamped, "~/init_box", self.on_init_box, RELIABLE)
        self._subscribe(RegionOfInterest, "~/init_roi", self.on_init_roi, RELIABLE)
        if self._settings.image_timeout > 0:
            steady = Clock(clock_type=ClockType.STEADY_TIME)  # runs under use_sim_time as well
            timer = self.create_timer(self._settings.image_timeout, self._on_silence, clock=steady)
            self._entities.append((self.destroy_timer, timer))
        self._active = True
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Leave the inputs; the track is kept."""
        self._active = False
        while self._entities:
            destroy, entity = self._entities.pop()
            destroy(entity)
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the track and take the outputs and services away."""
        self._session.drop("waiting for a box")
        self._newest = self._request = None
        for publisher in self._outputs.values():
            self.destroy_publisher(publisher)
        self._outputs.clear()
        self.destroy_service(self._reset_service)
        self.destroy_service(self._enable_service)
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop whatever runs."""
        self.on_deactivate(state)
        return super().on_shutdown(state)

    def _subscribe(self, kind: Any, topic: str, callback: Any, qos: QoSProfile) -> Any:
        subscription = self.create_subscription(
            kind,
            topic,
            callback,
            qos,
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        self._entities.append((self.destroy_subscription, subscription))
        return subscription

    # Inputs ---------------------------------------------------------------------------------

    def on_image(self, message: ImageMessage) -> None:
        """Process one image: start the box that waits for it, or follow the track, and publish."""
        arrival = time.monotonic()
        if not (self._active and self._enabled):
            return
        frame = Frame(message, self._stamp_of(message.header), arrival)
        order = self._gate.take(frame.stamp)
        if order in (Order.DUPLICATE, Order.LATE):
            return
        if order is Order.JUMP_BACK:
            self._on_jump_back()
        try:
            pixels = array_of(message, self._settings.white_level)
        except ImageError as error:
            self._hints.once(
                f"image {getattr(message, 'encoding', 'compressed')}", f"image refused: {error}"
            )
            return
        self._newest = frame
        self._publish(frame, self._started(frame, pixels) or self._followed(frame, pixels))

    def on_init_box(self, message: PolygonStamped) -> None:
        """Start or restart the track on the polygon's bounds, on the image of its stamp."""
        try:
            self._on_box(box_from_polygon(message), stamp_ns(message.header))
        except BoxError as error:
            self._refuse(error)

    def on_init_roi(self, message: RegionOfInterest) -> None:
        """Start or restart the track on a region of the newest image."""
        try:
            self._on_box(box_from_roi(message), 0)
        except BoxError as error:
            self._refuse(error)

    def _on_box(self, box: Box, stamp: int) -> None:
        """Start on the newest image, or wait for the image that the stamp names."""
        if not (self._active and self._enabled):
            self._refuse("the node is disabled or not active")
            return
        newest = self._newest
        if newest is None or stamp > newest.stamp:
            self._request = Request(box, stamp)
            if newest is None:
                self._hints.once(
                    "early box", "a box came before any image: it starts on the first one"
                )
            return
        if stamp and newest.stamp - stamp > self._settings.max_gap * SECOND:
            self._refuse(
                f"it was drawn {(newest.stamp - stamp) / SECOND:.2f} s before the newest image"
            )
            return
        self._request = Request(box, 0)
        pixels = array_of(newest.message, self._settings.white_level)
        estimate = self._started(newest, pixels)
        if estimate is not None:
            self._publish(newest, estimate)

    def _started(self, frame: Frame, pixels: Pixels) -> Estimate | None:
        """Start the box that waits, if it waits for this frame; None where nothing started."""
        request = self._request
        if request is None or request.stamp > frame.stamp:
            return None
        self._request = None
        try:
            estimate = self._session.start(pixels, frame.stamp, request.box, frame.header.frame_id)
        except ValueError as error:
            self._refuse(error)
            return None
        self.get_logger().info(f"tracking started on {request.box}")
        return estimate

    def _followed(self, frame: Frame, pixels: Pixels) -> Estimate | None:
        """Follow the track into this frame; a fault inside ends the track, not the node."""
        before = self._session.state
        try:
            estimate = self._session.follow(pixels, frame.stamp, frame.header.frame_id)
        except Exception as error:  # a robot must hear LOST, whatever went wrong in here
            self.get_logger().error(f"the tracker failed on an image: {error!r}")
            self._session.lose(f"internal error: {error!r}")
            return None
        if self._session.state is State.LOST and before is not State.LOST:
            self.get_logger().warning(f"target lost: {self._session.reason}")
        return estimate

    def _on_jump_back(self) -> None:
        """Time went back: nothing that was learnt of motion holds, and old boxes are void."""
        self.get_logger().warning("the stamps jumped back (a bag in a loop?): the track is reset")
        self._session.drop("time jumped back")
        self._newest = None

    def _stamp_of(self, header: Header) -> int:
        """The image's stamp, or the time of arrival where a driver leaves it at zero, ns."""
        stamp = stamp_ns(header)
        if stamp == 0:
            self._hints.once(
                "no stamp", "images carry no stamp: the time of arrival is taken, set header.stamp"
            )
            return int(self.get_clock().now().nanoseconds)
        return stamp

    def _refuse(self, why: object) -> None:
        goes_on = "; the running track goes on" if self._session.running else ""
        self.get_logger().warning(f"init box refused: {why}{goes_on}")

    # Outputs --------------------------------------------------------------------------------

    def _publish(self, frame: Frame, estimate: Estimate | None) -> None:
        """Publish an estimate and the status; in LOST and without a track the status alone."""
        header = frame.header
        if estimate is not None and estimate.state in (State.TRACKING, State.COASTING):
            self._send("box", lambda: polygon_from_box(estimate.box, header))
            self._send("pose", lambda: pose_from_estimate(estimate, header))
            self._send("velocity", lambda: twist_from_estimate(estimate, header))
        self._send("status", lambda: self._status(frame, estimate))

    def _status(self, frame: Frame, estimate: Estimate | None) -> DiagnosticArray:
        session = self._session
        status = Status(
            state=session.state,
            score=0.0 if estimate is None else float(estimate.score),
            latency=time.monotonic() - frame.arrival,
            age=session.age,
            reason=session.reason,
        )
        return status_message(status, self.get_fully_qualified_name(), frame.header)

    def _send(self, topic: str, make: Callable[[], Any]) -> None:
        """Publish on an output what ``make`` makes; nothing is made while nobody listens."""
        listened_to = self._outputs[topic].get_subscription_count() > 0
        if not listened_to and self._tap is None:
            return
        message = make()
        if self._tap is not None:
            self._tap(topic, message)
        if listened_to:
            self._outputs[topic].publish(message)

    # Services and hints ---------------------------------------------------------------------

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Drop the track and any box that waits: IDLE."""
        response.success = True
        response.message = f"was {self._session.state.value}, now IDLE"
        self._session.drop("reset: waiting for a box")
        self._request = None
        return response

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Switch the processing of images on or off; the track is kept, a pause is a gap."""
        self._enabled = request.data
        response.success = True
        response.message = "images are processed" if self._enabled else "images are ignored"
        return response

    def _on_silence(self) -> None:
        """Once after the start: if no image came, say what is waited for."""
        for entry in self._entities:
            if entry[0] == self.destroy_timer:
                entry[1].cancel()
        if self._gate.newest is not None or not self._enabled:
            return
        topic = self._image_input.topic_name
        publishers = self.get_publishers_info_by_topic(topic)
        reliability = self._image_input.qos_profile.reliability.name.lower()
        found = ", ".join(
            f"{p.node_name} ({p.topic_type}, {p.qos_profile.reliability.name.lower()})"
            for p in publishers
        )
        self._hints.once(
            "silence",
            f"no image after {self._settings.image_timeout:g} s: waiting on {topic} "
            f"({self._image_input.msg_type.__name__}, {reliability}); its publishers: "
            f"{found or 'none, remap with -r image:=/your/camera/image_raw'}",
        )


def main(args: list[str] | None = None) -> int:
    """Run the node until it is told to stop; 0 on a clean stop, 2 on a wrong parameter."""
    argv = sys.argv if args is None else ["tracker", *args]
    parser = argparse.ArgumentParser(
        prog="tracker",
        description="Follow one target on a camera stream.",
        epilog="example: ros2 run het_ros tracker --ros-args -r image:=/camera/image_raw",
    )
    parser.parse_args(remove_ros_args(argv)[1:])
    node = None
    try:
        rclpy.init(args=argv)
        node = TrackerNode()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except (ParameterException, ValueError) as error:
        print(f"tracker: {error}", file=sys.stderr)
        return 2
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
