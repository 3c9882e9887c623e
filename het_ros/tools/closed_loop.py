# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A rendered robot that follows a rendered figure with the real tracker and follower nodes.

``ros2 run het_ros closed_loop --out out/loop`` renders what the robot's camera sees, feeds
the tracker node, lets the follower node drive, moves the robot, and so on for a minute. It ends
with 1 if the figure was ever out of view.
"""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from rclpy.context import Context
from rclpy.parameter import Parameter
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Header
from tqdm import tqdm

from het_ros.ros.debug_image import debug_message
from het_ros.ros.follower_example import FollowerNode
from het_ros.ros.messages import box_from_polygon, header_of, polygon_from_box, stamp_ns
from het_ros.ros.status import status_values
from het_ros.ros.tracker_node import TrackerNode
from het_ros.scene import CameraState, Frame, Scene, SceneConfig
from het_ros.scene.honesty import CONFIDENT
from het_ros.tools.arguments import add_network, command
from het_ros.tools.drawing import annotate, write_words
from het_ros.tools.results import Row
from het_ros.tools.video import VideoWriter
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.estimate import State

FAR = 30.0  # m, depth of the street behind all
LOST_AFTER = 4.0  # s: the robot waits so long for who went behind a column
FASTEST = 1.2  # m/s: a robot slower than who it follows loses them
HIDDEN, SEEN = 0.02, 0.5  # visible part of the figure
OVERLAP = 0.3  # IoU from which on a box is on the figure
EXAMPLE = """examples:
  ros2 run het_ros closed_loop --out out/loop --seed 2
  ros2 run het_ros closed_loop --network models/nanotrackv3 --without-depth
"""
START = 1_000_000_000  # ns, stamp of the first image: 0 would mean "no stamp"


@dataclass(frozen=True)
class Moment:
    """One frame of the loop.

    Attributes:
        frame: what the camera saw, with the truth.
        row: what the tracker said.
        away: distance from the robot to the figure, m.
        command: (m/s forward, rad/s to the left).
        in_view: whether the figure is in the camera's view, hidden or not.
        clearance: from the robot to the nearest column's surface, m.
    """

    frame: Frame
    row: Row
    away: float
    command: tuple[float, float]
    in_view: bool
    clearance: float


class Loop:
    """Scene, robot and both nodes, stepped by hand in the scene's time.

    Attributes:
        tracker: the tracker node.

    Args:
        scene: what is rendered.
        distance: that the follower keeps, m.
        context: of the nodes.
        network: the tracker's parameter.
        depth: whether the tracker gets depth images.
    """

    def __init__(
        self,
        scene: Scene,
        distance: float,
        context: Context,
        network: str = "",
        depth: bool = True,
    ) -> None:
        self.scene = scene
        self._with_depth = depth
        self.robot = self._facing_the_target()
        self._time = 0.0
        self._outputs: dict[str, Any] = {}
        self.tracker = TrackerNode(
            context=context,
            config=TrackerConfig(lost_after=LOST_AFTER, network=network),
            tap=lambda topic, message: self._outputs.update({topic: message}),
        )
        self._follower = FollowerNode(
            clock=lambda: self._time,
            context=context,
            parameter_overrides=[
                Parameter("distance", value=distance),
                Parameter("max_linear", value=FASTEST),
                Parameter("drive_on", value=LOST_AFTER),
            ],
        )

    def run(self) -> Iterator[Moment]:
        """Step through the story."""
        for index in range(len(self.scene)):
            yield self._step(index)

    def close(self) -> None:
        """Destroy the nodes."""
        self.tracker.destroy_node()
        self._follower.destroy_node()

    def _step(self, index: int) -> Moment:
        self._time = index / self.scene.config.rate
        frame = self.scene.render(self._time, self.robot, index)
        header = header_of(START + round(self._time * 1e9), "camera")
        self.tracker.space.on_camera_info(self._camera_info(header))
        if self._with_depth:
            self.tracker.space.on_depth(self._depth(frame, header))
        self._outputs.clear()
        self.tracker.on_image(debug_message(frame.image, header))
        if index == 0 and frame.box is not None:
            self.tracker.on_init_box(polygon_from_box(frame.box, header))
        for topic in ("bearing", "target_velocity", "target_pose", "pose", "status"):
            if topic in self._outputs:
                getattr(self._follower, f"on_{topic}")(self._outputs[topic])
        command = self._follower.tick()
        moment = Moment(
            frame=frame,
            row=self._row(header),
            away=self._away(),
            command=command,
            in_view=self._in_view(frame),
            clearance=self._clearance(),
        )
        self._move(*command)
        return moment

    def _row(self, header: Header) -> Row:
        """The tracker's answer to this frame."""
        if "status" not in self._outputs:
            return Row(stamp_ns(header))
        values = status_values(self._outputs["status"])
        row = Row(stamp_ns(header), score=float(values["score"]), state=State(values["state"]))
        if "box" not in self._outputs:
            return row
        linear = self._outputs["velocity"].twist.twist.linear
        box = box_from_polygon(self._outputs["box"])
        return replace(row, box=box, velocity=(linear.x, linear.y))

    def _camera_info(self, header: Header) -> CameraInfo:
        lens = self.scene.lens
        matrix = [float(value) for value in lens.matrix.ravel()]
        return CameraInfo(header=header, width=lens.width, height=lens.height, k=matrix)

    def _depth(self, frame: Frame, header: Header) -> Image:
        """A depth camera's view: the figure where it is seen, columns, and the street far away."""
        lens = self.scene.lens
        metres = np.full((lens.height, lens.width), FAR, np.float32)
        target = self._seen_from_robot(*self.scene.target_at(frame.stamp))
        metres[frame.mask > 0] = max(target[1], 0.1)
        for column in self.scene.story.columns:
            right, forward = self._seen_from_robot(column.x, column.z)
            if forward > 0.3:
                edges = [
                    lens.width / 2 + lens.focal * (right + side * column.width / 2) / forward
                    for side in (-1, 1)
                ]
                left_edge, right_edge = (int(np.clip(edge, 0, lens.width)) for edge in edges)
                part = metres[:, left_edge:right_edge]
                np.minimum(part, np.float32(forward), out=part)
        return Image(
            header=header, width=lens.width, height=lens.height, encoding="32FC1",
            step=4 * lens.width, data=metres.tobytes(),
        )  # fmt: skip

    def _seen_from_robot(self, x: float, z: float) -> tuple[float, float]:
        """A place of the street as (right, forward) m."""
        dx, dz = x - self.robot.x, z - self.robot.z
        sin, cos = math.sin(self.robot.yaw), math.cos(self.robot.yaw)
        return cos * dx - sin * dz, sin * dx + cos * dz

    def _facing_the_target(self) -> CameraState:
        x, z = self.scene.target_at(0.0)
        return CameraState(x=x, z=z - 4.0, yaw=0.0)

    def _away(self) -> float:
        x, z = self.scene.target_at(self._time)
        return math.hypot(x - self.robot.x, z - self.robot.z)

    def _clearance(self) -> float:
        return min(
            math.hypot(column.x - self.robot.x, column.z - self.robot.z) - column.width / 2
            for column in self.scene.story.columns
        )

    def _in_view(self, frame: Frame) -> bool:
        lens = self.scene.lens
        return frame.box is not None and 0 <= frame.box.centre[0] <= lens.width

    def _move(self, linear: float, angular: float) -> None:
        """Drive a frame time: yaw is positive to the right, a turn to the left is positive."""
        dt = 1 / self.scene.config.rate
        yaw = self.robot.yaw - angular * dt
        self.robot = replace(
            self.robot,
            x=self.robot.x + linear * math.sin(yaw) * dt,
            z=self.robot.z + linear * math.cos(yaw) * dt,
            yaw=yaw,
            yaw_rate=-angular,
        )


def main(arguments: list[str] | None = None) -> int:
    """Run the loop, write the video, print how it went; 1 when the figure was lost."""
    parser = command("closed_loop", __doc__, EXAMPLE)
    parser.add_argument("--out", type=Path, default=Path("out/loop"), help="folder (out/loop)")
    parser.add_argument("--seed", type=int, default=0, help="of the scene (0)")
    parser.add_argument("--distance", type=float, default=4.0, help="to keep, m (4)")
    parser.add_argument("--without-depth", action="store_true", help="the camera measures none")
    add_network(parser)
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"
    scene = Scene(SceneConfig(story="patrol", seed=options.seed))
    context = Context()
    rclpy.init(context=context)
    depth = not options.without_depth
    loop = Loop(scene, options.distance, context, options.network, depth)
    moments: list[Moment] = []
    try:
        with VideoWriter(options.out / "loop.mp4", scene.config.rate) as video:
            for moment in tqdm(loop.run(), total=len(scene), unit="frame"):
                video.add(_caption(moment), round(moment.frame.stamp * 1e9))
                moments.append(replace(moment, frame=_without_images(moment.frame)))
    finally:
        loop.close()
        rclpy.try_shutdown(context=context)
    print("\n".join([*_figures(moments, scene.config.rate), f"look at   {options.out}/loop.mp4"]))
    return 0 if all(moment.in_view for moment in moments) else 1


def _figures(moments: list[Moment], rate: float) -> list[str]:
    """How it went, in lines of text."""
    in_view = np.mean([moment.in_view for moment in moments])
    hidden = sum(moment.frame.visible < HIDDEN for moment in moments) / rate
    seen = [moment for moment in moments if moment.frame.visible >= SEEN]
    tracked = np.mean([m.row.state is State.TRACKING and _on_it(m) for m in seen])
    beside = [m for m in moments if m.row.state is State.TRACKING and not _on_it(m)]
    confident = sum(m.row.score > CONFIDENT for m in beside)
    away = [moment.away for moment in moments]
    return [
        f"in view   {in_view:.1%} of {len(moments)} frames; wholly hidden for {hidden:.1f} s",
        f"tracked   {tracked:.1%} of the frames that show half of the figure; "
        f"TRACKING beside it in {len(beside)}, confident in {confident}",
        f"distance  {np.mean(away):.2f} m (mean), {min(away):.2f} to {max(away):.2f} m; "
        f"to the column at least {min(moment.clearance for moment in moments):.2f} m",
        f"commands  {_roughness(moments, 0):.4f} m/s and {_roughness(moments, 1):.4f} rad/s, root "
        "mean square of the change from one to the next",
    ]


def _roughness(moments: list[Moment], part: int) -> float:
    commands = np.array([moment.command[part] for moment in moments])
    return float(np.sqrt((np.diff(commands) ** 2).mean()))


def _on_it(moment: Moment) -> bool:
    box, truth = moment.row.box, moment.frame.box
    return box is not None and truth is not None and box.iou(truth) > OVERLAP


def _without_images(frame: Frame) -> Frame:
    nothing = np.empty((0, 0), np.uint8)
    return replace(frame, image=nothing, mask=nothing)


def _caption(moment: Moment) -> np.ndarray:
    linear, angular = moment.command
    picture = annotate(moment.frame.image, moment.row, moment.frame.box)
    words = f"{moment.away:.1f} m   {linear:+.2f} m/s   {angular:+.2f} rad/s"
    write_words(picture, words, (255, 255, 255), at_top=True)
    return picture


if __name__ == "__main__":
    sys.exit(main())
