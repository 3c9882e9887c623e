# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The node ``tracker``: one box on a camera stream in; box, velocity, status and more out."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PolygonStamped
from rclpy.clock import Clock, ClockType
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, Image, RegionOfInterest
from std_srvs.srv import SetBool, Trigger

from het_ros.ros.answers import Answers
from het_ros.ros.detections import vision_msgs
from het_ros.ros.detector import Detector
from het_ros.ros.frames import Frame, ImageMessage
from het_ros.ros.hints import Hints
from het_ros.ros.image_stream import NEWEST_ONLY, ImageStream
from het_ros.ros.input_hints import InputHints
from het_ros.ros.messages import BoxError
from het_ros.ros.offers import OfferedSubscription
from het_ros.ros.outputs import OUTPUTS, RELIABLE, Outputs, Tap, make_publisher
from het_ros.ros.pursuit import Pursuit
from het_ros.ros.quality import checked, overridable, subscription_events
from het_ros.ros.reports import Reports
from het_ros.ros.space import Space
from het_ros.ros.stamps import SECOND
from het_ros.ros.starts import Starts
from het_ros.ros.tuned_node import TunedNode
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import State

LOOK = 0.2  # s between two looks at what does not come
DEPTH = QoSProfile(depth=2, reliability=ReliabilityPolicy.BEST_EFFORT)  # one may be early


class TrackerNode(TunedNode):
    """Follows one target; what is done with frames and boxes is in :class:`Pursuit`.

    With ``autostart`` (the default) the node is active when its constructor returns. Without an
    executor it can be driven by hand, deterministically and in one thread: call
    :meth:`on_init_box` and :meth:`on_image` with messages and take what it publishes from
    ``tap``. Deactivating keeps the track, cleaning up drops it; a pause counts as a gap between
    images, so after more than ``max_gap`` the track is LOST.

    Attributes:
        space: takes camera_info and depth, by hand as well.
        images: where its images come from.
        starts: takes points and detections, by hand as well.

    Args:
        name: node name, first part of the output topics.
        tap: called as ``tap(topic, message)`` for everything published, subscribers or not (but
            "debug_image", which is drawn for subscribers only); topic is a key of ``OUTPUTS``.
        config: the tracker's defaults, under the parameters that are set.
        source: another node of the same process whose images this one looks at as well, whatever
            state that node is in; each is taken and converted once for both.
        **options: of rclpy's Node (context, namespace, parameter_overrides, cli_args...).
    """

    def __init__(
        self,
        name: str = "tracker",
        *,
        tap: Tap | None = None,
        config: TrackerConfig | None = None,
        source: TrackerNode | None = None,
        **options: Any,
    ) -> None:
        super().__init__(name, config, **options)
        self._tap = tap
        self._hints = Hints(self.get_logger())
        self.space = Space(self.settings, self._hints)
        self._input_hints = InputHints(self, self.space, self._hints)
        detector = Detector(self.resolve_topic_name("detections_in"))
        self.starts = Starts(detector, self._start, lambda why: self._pursuit.refuse(why))
        self.images = self._new_images() if source is None else source.images
        self._active = False
        self._enabled = True
        self._outputs = Outputs(self, {}, None)
        self._make_pursuit()
        if self.settings.autostart:
            self.start()
        else:
            self.get_logger().info("autostart is false: a lifecycle manager starts this node")

    @property
    def state(self) -> State:
        """Where the track stands; LOST while no image comes that could tell."""
        return self._reports.state

    @property
    def reason(self) -> str:
        """Why :attr:`state` is not TRACKING; empty while it is."""
        return self._reports.reason

    # Lifecycle ------------------------------------------------------------------------------

    def configure(self) -> None:
        """Make outputs and services, on a stream that nothing is known of."""
        self.space.forget()
        self._outputs = Outputs(self, self._kinds(), self._tap)
        self.configured.callback(self._outputs.destroy)
        self._make_pursuit()
        self.configured.callback(lambda: self._pursuit.drop("waiting for a box"))
        self._diagnostics = make_publisher(self, DiagnosticArray, "/diagnostics")
        self.configured.callback(self.destroy_publisher, self._diagnostics)
        for kind, name, serve in (
            (Trigger, "~/reset", self._on_reset),
            (SetBool, "~/enable", self._on_enable),
        ):
            service = self.create_service(kind, name, serve)
            self.configured.callback(self.destroy_service, service)
        self._every(self.settings.diagnostics_period, self._report)
        self._every(LOOK, self._look)
        self._depth_wait = self._every(LOOK, self._work)
        self._depth_wait.cancel()
        self._wake = self.create_guard_condition(self._work)
        self.configured.callback(self.destroy_guard_condition, self._wake)

    def activate(self) -> None:
        """Subscribe to the inputs."""
        self.images.join(self.on_frame)
        self.activated.callback(self.images.leave, self.on_frame)
        self._subscribe(PolygonStamped, "~/init_box", self.on_init_box, RELIABLE)
        self._subscribe(RegionOfInterest, "~/init_roi", self.on_init_roi, RELIABLE)
        self._subscribe(PointStamped, "~/init_point", self.on_init_point, RELIABLE)
        self._subscribe(CameraInfo, "camera_info", self.space.on_camera_info, NEWEST_ONLY)
        depth = OfferedSubscription(
            self, Image, "depth", self._on_depth, DEPTH, self.settings.reliability
        )
        self.activated.callback(depth.destroy)
        if vision_msgs is not None:
            kind = vision_msgs.Detection2DArray
            self._subscribe(kind, "detections_in", self.starts.on_detections, RELIABLE)
        self._active = True
        self._reports.watch.begin()
        self.activated.callback(setattr, self, "_active", False)
        box_topic = self.resolve_topic_name("~/init_box")
        self.get_logger().info(f"active: images from {self.images.topic}, boxes on {box_topic}")

    def _kinds(self) -> dict[str, type]:
        """Message type of each output."""
        if vision_msgs is None:
            self.get_logger().debug("vision_msgs is not installed: there is no ~/detections")
            return OUTPUTS
        return {**OUTPUTS, "detections": vision_msgs.Detection2DArray}

    def _make_pursuit(self) -> None:
        """Make what follows a target, and what tells of it."""
        self._pursuit = Pursuit(
            self.tracker_config,
            self.settings,
            self.get_logger(),
            self.space.may_hold,
            self.space.patience,
            self.starts.detector.near,
        )
        name = self.get_fully_qualified_name()
        self._answers = Answers(name, self._outputs, self.space, self.settings)
        self._reports = Reports(self, self._pursuit, self._answers)

    def _new_images(self) -> ImageStream:
        compressed = self.settings.image_transport == "compressed"
        return ImageStream(self, compressed, self.settings.reliability, self._hints)

    def _every(self, seconds: float, callback: Callable[[], None]) -> Any:
        """A timer that runs under use_sim_time as well, until the node is cleaned up."""
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        timer = self.create_timer(seconds, callback, clock=steady)
        self.configured.callback(self.destroy_timer, timer)
        return timer

    def _subscribe(self, kind: Any, topic: str, callback: Any, qos: QoSProfile) -> None:
        subscription = checked(
            lambda: self.create_subscription(
                kind,
                topic,
                callback,
                copy(qos),  # overrides are written into it
                event_callbacks=subscription_events(self, topic),
                qos_overriding_options=overridable(),
            ),
            self.resolve_topic_name(topic),
            "subscription",
        )
        self.activated.callback(self.destroy_subscription, subscription)

    # Inputs ---------------------------------------------------------------------------------

    def on_image(self, message: ImageMessage) -> None:
        """Process one image: start the box that waits for it, or follow the track, and publish.

        Other nodes on the same images get it as well.
        """
        self.images.take(message)

    def on_frame(self, frame: Frame) -> None:
        """Process one frame of the stream."""
        if self._active and self._enabled:
            self._pursuit.on_frame(frame)
            self._work()

    def on_init_box(self, message: PolygonStamped) -> None:
        """Start or restart the track on the polygon's bounds, on the image of its stamp."""
        self.starts.on_box(message)

    def on_init_roi(self, message: RegionOfInterest) -> None:
        """Start or restart the track on a region of the newest image."""
        self.starts.on_roi(message)

    def on_init_point(self, message: PointStamped) -> None:
        """Start or restart the track on what is detected around a point."""
        self.starts.on_point(message, self.settings.box_tolerance)

    def _on_depth(self, message: Image, _: dict[str, Any]) -> None:
        """Take depth, and see to the images that wait for it, or waited too short."""
        self.space.on_depth(message)
        self._work()
        self._answers.place_late()

    def _start(self, box: Box, stamp: int) -> None:
        """Start the track on a box; raises BoxError."""
        if not (self._active and self._enabled):
            raise BoxError("the node is disabled or not active")
        outcome = self._pursuit.on_box(box, stamp)
        if outcome is not None and outcome.published:
            self._answers.publish(outcome)
        if self._pursuit.busy:
            self._work()

    def _work(self) -> None:
        """Process the next frame; with an executor, let images in before the one after it.

        Without an executor nothing comes in meanwhile, and no frame waits for its depth.
        """
        spun = self.executor is not None
        self._depth_wait.cancel()
        while self._pursuit.busy:
            if spun and (left := self._pursuit.left):
                self._depth_wait.timer_period_ns = int(left * SECOND) + 1
                self._depth_wait.reset()
                return
            outcome = self._pursuit.step(hurry=spun)
            if outcome is not None:
                self._reports.processed()
                if outcome.published:
                    self._answers.publish(outcome)
            if spun:
                if self._pursuit.busy:
                    self._wake.trigger()
                return

    # Parameters, services, reports ----------------------------------------------------------

    def tuned(self) -> None:
        """Take new values: the node's at once, the tracker's with a new box."""
        self.space.settings = self._answers.settings = self.settings
        self._pursuit.configure(self.tracker_config, self.settings)

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Drop the track and any box that waits: IDLE."""
        response.success = True
        response.message = f"was {self.state.value}, now IDLE"
        self._pursuit.drop("reset: waiting for a box")
        self.starts.detector.drop()
        self.get_logger().info(f"reset: {response.message}")
        return response

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Switch the processing of images on or off; the track is kept, a pause is a gap."""
        if request.data and not self._enabled:
            self._reports.watch.begin()
        self._enabled = request.data
        response.success = True
        response.message = "images are processed" if self._enabled else "images are ignored"
        self.get_logger().info(f"enable: {response.message}")
        return response

    def _look(self) -> None:
        """Tell of images, inputs and detections that do not come."""
        if self._active and self._enabled:
            self.starts.look()
            self._input_hints.look(self._outputs)
            self._reports.look(self.images)

    def _report(self) -> None:
        """Publish on /diagnostics."""
        working = self._active and self._enabled
        self._diagnostics.publish(self._reports.diagnostics(self.images.dropped, working))
