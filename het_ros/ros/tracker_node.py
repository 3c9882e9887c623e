"""The node ``tracker``: one box on a camera stream in; box, velocity, status and more out."""

from __future__ import annotations

import time
from collections.abc import Callable
from copy import copy
from functools import wraps
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PolygonStamped
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, RegionOfInterest
from std_msgs.msg import Header
from std_srvs.srv import SetBool, Trigger

from het_ros.ros.answers import Answers
from het_ros.ros.detections import vision_msgs
from het_ros.ros.frames import Conversion, Frame, ImageMessage
from het_ros.ros.hints import Hints
from het_ros.ros.messages import BoxError, box_from_polygon, box_from_roi, stamp_ns
from het_ros.ros.outputs import OUTPUTS, RELIABLE, Outputs, Tap
from het_ros.ros.parameters import NodeConfig, declare, read
from het_ros.ros.pursuit import Outcome, Pursuit
from het_ros.ros.quality import explain_silence, subscription_events
from het_ros.ros.space import Space
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import State

# Depth 1: with a deeper queue a busy node works on old images, and latency grows by the depth.
NEWEST_ONLY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def _told(transition: Callable[..., TransitionCallbackReturn]) -> Callable[..., Any]:
    """A transition that tells why it failed; rclpy swallows what is raised in one."""

    @wraps(transition)
    def telling(self: TrackerNode, state: LifecycleState) -> TransitionCallbackReturn:
        try:
            return transition(self, state)
        except Exception as error:
            self._failure = error
            self.get_logger().fatal(f"{transition.__name__} failed: {error!r}")
            return TransitionCallbackReturn.FAILURE

    return telling


class TrackerNode(LifecycleNode):
    """Follows one target; what is done with frames and boxes is in :class:`Pursuit`.

    With ``autostart`` (the default) the node is active when its constructor returns. Without an
    executor it can be driven by hand, deterministically and in one thread: call
    :meth:`on_init_box` and :meth:`on_image` with messages and take what it publishes from
    ``tap``. Deactivating keeps the track, cleaning up drops it; a pause counts as a gap between
    images, so after more than ``max_gap`` the track is LOST.

    Attributes:
        space: takes camera_info and depth, by hand as well.

    Args:
        name: node name, first part of the output topics.
        tap: called as ``tap(topic, message)`` for everything published, subscribers or not (but
            "debug_image", which is drawn for subscribers only); topic is a key of ``OUTPUTS``.
        config: the tracker's defaults, under the parameters that are set.
        source: another node of the same process whose images this one looks at as well; each is
            taken and converted once for both, and none come while ``source`` is not active.
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
        self._source = source
        self._sharing: list[TrackerNode] = []
        self._hints = Hints(self.get_logger())
        declare(self, NodeConfig())
        declare(self, config or TrackerConfig())
        self._settings = read(self, NodeConfig)
        self._pursuit = self._new_pursuit()
        self.space = Space(self._settings, self._hints)
        self._active = False
        self._enabled = True
        self._inputs: list[tuple[Callable[[Any], Any], Any]] = []
        self._outputs = Outputs(self, {}, None)
        self._answers = self._new_answers()
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)
        self._failure: Exception | None = None
        if self._settings.autostart:
            for transition in (self.trigger_configure, self.trigger_activate):
                if transition() is not TransitionCallbackReturn.SUCCESS:
                    raise RuntimeError(f"the node did not start: {self._failure!r}")

    @property
    def state(self) -> State:
        """Where the track stands."""
        return self._pursuit.session.state

    @property
    def reason(self) -> str:
        """Why :attr:`state` is not TRACKING; empty while it is."""
        return self._pursuit.session.reason

    # Lifecycle ------------------------------------------------------------------------------

    @_told
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make outputs and services, on a stream that nothing is known of."""
        self._pursuit = self._new_pursuit()
        kinds = dict(OUTPUTS)
        if vision_msgs is None:
            self.get_logger().debug("vision_msgs is not installed: there is no ~/detections")
        else:
            kinds["detections"] = vision_msgs.Detection2DArray
        self._outputs = Outputs(self, kinds, self._tap)
        self._answers = self._new_answers()
        self._diagnostics = self.create_publisher(
            DiagnosticArray,
            "/diagnostics",
            copy(RELIABLE),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        self._offered = [
            self.create_service(Trigger, "~/reset", self._on_reset),
            self.create_service(SetBool, "~/enable", self._on_enable),
        ]
        steady = Clock(clock_type=ClockType.STEADY_TIME)  # runs under use_sim_time as well
        period = self._settings.diagnostics_period
        self._reporter = self.create_timer(period, self._report, clock=steady)
        self._wake = self.create_guard_condition(self._work)
        return super().on_configure(state)

    @_told
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Subscribe to the inputs."""
        if self._source is None:
            self._take_images()
        else:
            self._source.share_with(self)
        self._subscribe(PolygonStamped, "~/init_box", self.on_init_box, RELIABLE)
        self._subscribe(RegionOfInterest, "~/init_roi", self.on_init_roi, RELIABLE)
        self._subscribe(CameraInfo, "camera_info", self.space.on_camera_info, NEWEST_ONLY)
        self._subscribe(Image, "depth", self.space.on_depth, NEWEST_ONLY)
        self._active = True
        return super().on_activate(state)

    def share_with(self, node: TrackerNode) -> None:
        """Let another node look at this one's images."""
        if node not in self._sharing:
            self._sharing.append(node)

    def _take_images(self) -> None:
        """Subscribe to images, and say so if none come."""
        compressed = self._settings.image_transport == "compressed"
        topic = self.resolve_topic_name("image") + ("/compressed" if compressed else "")
        kind = CompressedImage if compressed else Image
        self._image_input = self._subscribe(kind, topic, self.on_image, NEWEST_ONLY)
        if self._settings.image_timeout > 0:
            steady = Clock(clock_type=ClockType.STEADY_TIME)
            self._silence = self.create_timer(
                self._settings.image_timeout, self._on_silence, clock=steady
            )
            self._inputs.append((self.destroy_timer, self._silence))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Leave the inputs; the track is kept."""
        self._active = False
        while self._inputs:
            destroy, entity = self._inputs.pop()
            destroy(entity)
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Drop the track and take outputs and services away."""
        self._pursuit.drop("waiting for a box")
        self._outputs.destroy()
        self.destroy_publisher(self._diagnostics)
        self.destroy_timer(self._reporter)
        self.destroy_guard_condition(self._wake)
        while self._offered:
            self.destroy_service(self._offered.pop())
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop whatever runs."""
        self.on_deactivate(state)
        return super().on_shutdown(state)

    def _new_pursuit(self) -> Pursuit:
        return Pursuit(read(self, TrackerConfig), self._settings, self.get_logger())

    def _new_answers(self) -> Answers:
        name = self.get_fully_qualified_name()
        return Answers(name, self._outputs, self.space, self._settings)

    def _subscribe(self, kind: Any, topic: str, callback: Any, qos: QoSProfile) -> Any:
        subscription = self.create_subscription(
            kind,
            topic,
            callback,
            copy(qos),  # overrides are written into it
            event_callbacks=subscription_events(self, topic),
            qos_overriding_options=QoSOverridingOptions.with_default_policies(),
        )
        self._inputs.append((self.destroy_subscription, subscription))
        return subscription

    # Inputs ---------------------------------------------------------------------------------

    def on_image(self, message: ImageMessage) -> None:
        """Process one image: start the box that waits for it, or follow the track, and publish."""
        arrival = time.monotonic()
        shared = Conversion(message) if self._sharing else None
        frame = Frame(message, self._stamp_of(message.header), arrival, shared)
        for node in (self, *self._sharing):
            node.on_frame(frame)
        if shared is not None:
            shared.close()

    def on_frame(self, frame: Frame) -> None:
        """Process a frame that this node or another one took."""
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
            self._answer(outcome)
        if self._pursuit.busy:
            self._work()

    def _work(self) -> None:
        """Process the next frame; with an executor, let images in before the one after it."""
        spun = self.executor is not None
        while self._pursuit.busy:
            outcome = self._pursuit.step(hurry=spun)
            if outcome is not None and outcome.published:
                self._answer(outcome)
            if spun:
                if self._pursuit.busy:
                    self._wake.trigger()
                return

    def _answer(self, outcome: Outcome) -> None:
        """Publish an outcome, and end a track whose box holds another thing by its depth."""
        self._answers.publish(outcome)
        patience = self._settings.depth_patience
        strange = self.space.other_thing_for
        if outcome.state is State.TRACKING and 0 < patience <= strange:
            reason = f"the depth in the box has been another thing's for {strange:.1f} s"
            self._pursuit.session.lose(f"{reason}: send a new box")
            self.get_logger().warning(f"target lost: {reason}")

    def _stamp_of(self, header: Header) -> int:
        """The image's stamp, or the time of arrival where a driver leaves it at zero, ns."""
        stamp = stamp_ns(header)
        if stamp == 0:
            self._hints.once(
                "no stamp", "images carry no stamp: the time of arrival is taken, set header.stamp"
            )
            return int(self.get_clock().now().nanoseconds)
        return stamp

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

    def _on_silence(self) -> None:
        """Once after the start: if no image came, say what is waited for."""
        self._silence.cancel()
        if not self._pursuit.started and self._enabled:
            timeout = self._settings.image_timeout
            self._hints.once("silence", explain_silence(self, self._image_input, timeout))

    def _report(self) -> None:
        """Publish on /diagnostics."""
        self._diagnostics.publish(
            self._answers.health.report(
                self.get_fully_qualified_name(),
                self.get_clock().now().to_msg(),
                self._settings.diagnostics_period,
                self._pursuit.counts,
                self.state.value,
                self._active and self._enabled,
            )
        )
