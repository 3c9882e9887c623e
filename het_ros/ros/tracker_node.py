# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The node ``tracker``: one box on a camera stream in; box, velocity, status and more out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from copy import copy
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from sensor_msgs.msg import CameraInfo, Image, RegionOfInterest
from std_srvs.srv import SetBool, Trigger

from het_ros.ros.answers import Answers
from het_ros.ros.detections import vision_msgs
from het_ros.ros.frames import Frame, ImageMessage
from het_ros.ros.hints import Hints
from het_ros.ros.image_stream import NEWEST_ONLY, ImageStream
from het_ros.ros.managed_node import ManagedNode
from het_ros.ros.messages import BoxError, box_from_polygon, box_from_roi, stamp_ns
from het_ros.ros.outputs import OUTPUTS, RELIABLE, Outputs, Tap
from het_ros.ros.parameters import NodeConfig, declare, read
from het_ros.ros.pursuit import Pursuit
from het_ros.ros.quality import overridable, subscription_events
from het_ros.ros.space import Space
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import State


class TrackerNode(ManagedNode):
    """Follows one target; what is done with frames and boxes is in :class:`Pursuit`.

    With ``autostart`` (the default) the node is active when its constructor returns. Without an
    executor it can be driven by hand, deterministically and in one thread: call
    :meth:`on_init_box` and :meth:`on_image` with messages and take what it publishes from
    ``tap``. Deactivating keeps the track, cleaning up drops it; a pause counts as a gap between
    images, so after more than ``max_gap`` the track is LOST.

    Attributes:
        space: takes camera_info and depth, by hand as well.
        images: where its images come from.

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
        super().__init__(name, **options)
        self._tap = tap
        self._hints = Hints(self.get_logger())
        declare(self, NodeConfig())
        declare(self, config or TrackerConfig())
        self._settings = read(self, NodeConfig)
        self.space = Space(self._settings, self._hints)
        self._pursuit = self._new_pursuit()
        self.images = self._new_images() if source is None else source.images
        self._active = False
        self._enabled = True
        self._outputs = Outputs(self, {}, None)
        self._answers = self._new_answers()
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        if self._settings.autostart:
            self.start()

    @property
    def state(self) -> State:
        """Where the track stands."""
        return self._pursuit.session.state

    @property
    def reason(self) -> str:
        """Why :attr:`state` is not TRACKING; empty while it is."""
        return self._pursuit.session.reason

    # Lifecycle ------------------------------------------------------------------------------

    def configure(self) -> None:
        """Make outputs and services, on a stream that nothing is known of."""
        self.space.forget()
        self._pursuit = self._new_pursuit()
        self.configured.callback(lambda: self._pursuit.drop("waiting for a box"))
        self._outputs = Outputs(self, self._kinds(), self._tap)
        self.configured.callback(self._outputs.destroy)
        self._answers = self._new_answers()
        self._diagnostics = self.create_publisher(
            DiagnosticArray,
            "/diagnostics",
            copy(RELIABLE),
            qos_overriding_options=overridable(),
        )
        self.configured.callback(self.destroy_publisher, self._diagnostics)
        for kind, name, serve in (
            (Trigger, "~/reset", self._on_reset),
            (SetBool, "~/enable", self._on_enable),
        ):
            service = self.create_service(kind, name, serve)
            self.configured.callback(self.destroy_service, service)
        steady = Clock(clock_type=ClockType.STEADY_TIME)  # runs under use_sim_time as well
        reporter = self.create_timer(self._settings.diagnostics_period, self._report, clock=steady)
        self.configured.callback(self.destroy_timer, reporter)
        self._wake = self.create_guard_condition(self._work)
        self.configured.callback(self.destroy_guard_condition, self._wake)

    def activate(self) -> None:
        """Subscribe to the inputs."""
        self.images.join(self.on_frame)
        self.activated.callback(self.images.leave, self.on_frame)
        self._subscribe(PolygonStamped, "~/init_box", self.on_init_box, RELIABLE)
        self._subscribe(RegionOfInterest, "~/init_roi", self.on_init_roi, RELIABLE)
        self._subscribe(CameraInfo, "camera_info", self.space.on_camera_info, NEWEST_ONLY)
        self._subscribe(Image, "depth", self.space.on_depth, NEWEST_ONLY)
        self._active = True
        self.activated.callback(setattr, self, "_active", False)
        box_topic = self.resolve_topic_name("~/init_box")
        self.get_logger().info(f"active: images from {self.images.topic}, boxes on {box_topic}")

    def _kinds(self) -> dict[str, type]:
        """Message type of each output."""
        if vision_msgs is None:
            self.get_logger().debug("vision_msgs is not installed: there is no ~/detections")
            return OUTPUTS
        return {**OUTPUTS, "detections": vision_msgs.Detection2DArray}

    def _new_pursuit(self) -> Pursuit:
        witness = self.space.may_hold
        return Pursuit(read(self, TrackerConfig), self._settings, self.get_logger(), witness)

    def _new_images(self) -> ImageStream:
        compressed = self._settings.image_transport == "compressed"
        return ImageStream(self, compressed, self._settings.image_timeout, self._hints)

    def _new_answers(self) -> Answers:
        name = self.get_fully_qualified_name()
        return Answers(name, self._outputs, self.space, self._settings)

    def _subscribe(self, kind: Any, topic: str, callback: Any, qos: QoSProfile) -> None:
        subscription = self.create_subscription(
            kind,
            topic,
            callback,
            copy(qos),  # overrides are written into it
            event_callbacks=subscription_events(self, topic),
            qos_overriding_options=overridable(),
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
        self._on_box(lambda: box_from_polygon(message), stamp_ns(message.header))

    def on_init_roi(self, message: RegionOfInterest) -> None:
        """Start or restart the track on a region of the newest image."""
        self._on_box(lambda: box_from_roi(message), 0)

    def _on_box(self, box: Callable[[], Box], stamp: int) -> None:
        try:
            if not (self._active and self._enabled):
                raise BoxError("the node is disabled or not active")
            outcome = self._pursuit.on_box(box(), stamp)
        except BoxError as error:
            self._pursuit.refuse(error)
            return
        if outcome is not None and outcome.published:
            self._answers.publish(outcome)
        if self._pursuit.busy:
            self._work()

    def _work(self) -> None:
        """Process the next frame; with an executor, let images in before the one after it."""
        spun = self.executor is not None
        while self._pursuit.busy:
            outcome = self._pursuit.step(hurry=spun)
            if outcome is not None and outcome.published:
                self._answers.publish(outcome)
            if spun:
                if self._pursuit.busy:
                    self._wake.trigger()
                return

    # Parameters, services, hints ------------------------------------------------------------

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        """Refuse values that do not fit, each alone or with the others, with the reason."""
        changed = {parameter.name: parameter.value for parameter in parameters}
        try:
            read(self, NodeConfig, **changed)
            read(self, TrackerConfig, **changed)
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, _: list[Parameter]) -> None:
        """Take new values between two frames: the node's at once, the tracker's with a new box."""
        self._settings = read(self, NodeConfig)
        self.space.settings = self._answers.settings = self._settings
        self._pursuit.configure(read(self, TrackerConfig), self._settings)

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Drop the track and any box that waits: IDLE."""
        response.success = True
        response.message = f"was {self.state.value}, now IDLE"
        self._pursuit.drop("reset: waiting for a box")
        return response

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        """Switch the processing of images on or off; the track is kept, a pause is a gap."""
        self._enabled = request.data
        response.success = True
        response.message = "images are processed" if self._enabled else "images are ignored"
        return response

    def _report(self) -> None:
        """Publish on /diagnostics."""
        self._diagnostics.publish(
            self._answers.health.report(
                self.get_fully_qualified_name(),
                self.get_clock().now().to_msg(),
                self._settings.diagnostics_period,
                self._pursuit.counts | Counter(dropped=self.images.dropped),
                self.state.value,
                self._active and self._enabled,
            )
        )
