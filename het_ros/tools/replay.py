# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Run a bag through the tracker's node in this process: every frame, as fast as it goes.

The node is the very class that ``ros2 run het_ros tracker`` starts, fed with the bag's messages
one by one. Nothing depends on timing: the same bag and parameters give the same track.csv.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.exceptions import ParameterException
from rclpy.serialization import deserialize_message, serialize_message
from tqdm import tqdm

from het_ros.ros.threads import one_thread
from het_ros.ros.tracker_node import TrackerNode
from het_ros.tools.arguments import INTERRUPTED, add_bag, add_parameters, command
from het_ros.tools.bag_messages import stamp_of
from het_ros.tools.bag_reader import BagReader, header_stamp
from het_ros.tools.bag_writer import BagWriter
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.message_types import message_class
from het_ros.tools.outputs import DEFAULT_TRACKER, OUTPUT_TYPES
from het_ros.tools.player import timeline
from het_ros.tools.report import ResultsFolder, write_report
from het_ros.tools.summary import Summary
from het_ros.tools.tracker_arguments import tracker_arguments
from het_ros.tracking.box import Box

EXAMPLE = """example:
  ros2 run het_ros replay bags/follow_walk --out out/replay -p seed:=3
"""


def replay(
    bag: BagReader,
    folder: ResultsFolder,
    *,
    init: Box | None = None,
    parameters: Sequence[str] = (),
) -> tuple[Summary, bool]:
    """Feed a bag to a node of our own and write the results.

    Args:
        bag: what to replay.
        folder: where results go.
        init: target in the first frame, px; by default the bag's own init box.
        parameters: the node's, each as "name:=value".

    Returns:
        The summary, and whether the whole bag was replayed (False after Ctrl-C).

    Raises:
        BagError: the bag cannot be replayed.
    """
    folder.clear()
    arguments = tracker_arguments(bag, parameters)
    # Nobody outside is to hear or disturb a replay.
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "OFF"
    context = Context()
    rclpy.init(context=context)
    try:
        with StopRequest() as stop, BagWriter(folder.bag) as recording:
            tap = _recording_tap(recording)
            node = TrackerNode(tap=tap, context=context, cli_args=arguments)
            try:
                stamps = _feed(bag, node, init, stop)
            finally:
                node.destroy_node()
    finally:
        rclpy.try_shutdown(context=context)
    return write_report(bag, stamps, folder), not stop


def _recording_tap(recording: BagWriter) -> Any:
    for name, kind in OUTPUT_TYPES.items():
        recording.add_topic(f"{DEFAULT_TRACKER}/{name}", kind)

    def tap(name: str, message: Any) -> None:
        if name in OUTPUT_TYPES:
            topic, kind = f"{DEFAULT_TRACKER}/{name}", OUTPUT_TYPES[name]
            recording.write_cdr(topic, kind, serialize_message(message), stamp_of(message))

    return tap


def _feed(bag: BagReader, node: TrackerNode, init: Box | None, stop: StopRequest) -> list[int]:
    """Hand every message to whom it would reach; return the images' stamps, ns.

    Without an executor the node does all its work within the call, so that nothing waits.
    """
    stamps: list[int] = []
    inputs = {heard.topic_name: heard.callback for heard in node.subscriptions}
    inputs[node.images.topic] = node.on_image
    with tqdm(total=bag.frames, desc="replay", unit="frame", delay=2) as progress:
        for recorded in timeline(bag, init):
            if stop:
                break
            if recorded.topic in inputs:
                message = deserialize_message(recorded.cdr, message_class(recorded.kind))
                inputs[recorded.topic](message)
            if recorded.topic == bag.image_topic:
                stamps.append(header_stamp(recorded.cdr))
                progress.update()
    return stamps


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = command("replay", __doc__, EXAMPLE)
    add_bag(parser, out="out/replay")
    add_parameters(parser)
    options = parser.parse_args(argv)
    one_thread()
    folder = ResultsFolder(options.out)
    try:
        with BagReader(options.bag, options.image_topic) as bag:
            summary, whole = replay(bag, folder, init=options.init, parameters=options.parameters)
    except (OSError, ValueError, ParameterException) as error:
        print(f"replay: {error}", file=sys.stderr)
        return 1
    print("\n".join([*summary.lines(), f"results   {folder.path}"]))
    return 0 if whole else INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
