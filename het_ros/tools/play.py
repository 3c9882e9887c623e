# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Play a bag's images and boxes to a running tracker in real time, and record its answers."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from tqdm import tqdm

from het_ros.tools.arguments import INTERRUPTED, add_bag, command, split_ros_arguments
from het_ros.tools.bag_reader import BagReader, header_stamp
from het_ros.tools.bag_writer import BagWriter
from het_ros.tools.handshake import LONGEST_SPIN, NobodyListensError, Spin, wait_until_known
from het_ros.tools.interrupt import StopRequest
from het_ros.tools.outputs import DEFAULT_TRACKER
from het_ros.tools.play_clock import PlayClock
from het_ros.tools.player import Player
from het_ros.tools.recorder import Recorder, outputs_from
from het_ros.tools.report import ResultsFolder, write_report
from het_ros.tools.transport import use_profile
from het_ros.tracking.box import Box

WAIT = 10.0  # s for the tracker to be there
LAST_ANSWER = 2.0  # s of silence after which no more answers are expected

EXAMPLE = """example, in two terminals:
  ros2 run het_ros tracker --ros-args -p image_transport:=compressed
  ros2 run het_ros play bags/follow_walk --out out/play

Topics are remapped like any node's: add --ros-args -r /image:=/camera/image_raw
"""


def play(
    bag: BagReader,
    recording: Path,
    stop: StopRequest,
    *,
    tracker: str = DEFAULT_TRACKER,
    rate: float = 1.0,
    init: Box | None = None,
    wait: float = WAIT,
    without_box: bool = False,
    now: bool = False,
    ros_arguments: Sequence[str] = (),
    alive: Callable[[], None] = lambda: None,
) -> list[int]:
    """Play a bag to a tracker that runs elsewhere and record its answers.

    Args:
        bag: what to play.
        recording: bag to write.
        stop: ends the play; what came until then is recorded.
        tracker: full name of the tracker's node.
        rate: 1 is real time, 2 twice as fast.
        init: target in the first frame, px; by default the bag's own init box.
        wait: s for the tracker to be there.
        without_box: leave the bag's own init box out: somebody else sends one.
        now: stamp everything with the time of the play; what is recorded has the bag's stamps.
        ros_arguments: of the playing node, from ``--ros-args`` on.
        alive: called often; may raise when playing on makes no sense.

    Returns:
        Header stamps of the frames that were sent, ns.

    Raises:
        BagError: the bag cannot be played.
        NobodyListensError: no tracker was there.
        ValueError: the rate is not positive.
    """
    if not 0 < rate < float("inf"):
        raise ValueError(f"a rate of {rate:g} makes no sense: 1 is real time, 2 twice as fast")
    use_profile()
    rclpy.init(args=list(ros_arguments), signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("het_ros_play")
    try:
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def spin(seconds: float) -> None:
            alive()
            executor.spin_once(timeout_sec=seconds)

        with BagWriter(recording) as bag_of_answers:
            clock = PlayClock(rate) if now else None
            player = Player(node, bag, tracker, init, without_box, clock)
            possible = outputs_from(bag)
            recorder = Recorder(node, bag_of_answers, tracker, clock, outputs=possible)
            player.wait_for_subscriber(spin, wait, stop)
            _wait_for_tracker(recorder, tracker, spin, wait, stop)
            wait_until_known(node, tracker, spin, wait, stop)
            if clock is not None:
                clock.begin(time.time_ns())
            return _play_and_record(player, recorder, spin, rate, stop)
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def _wait_for_tracker(
    recorder: Recorder, tracker: str, spin: Spin, seconds: float, stop: StopRequest
) -> None:
    end = time.monotonic() + seconds
    while not stop and not recorder.connected:
        if time.monotonic() > end:
            raise NobodyListensError(
                f"somebody takes the images, but no {tracker}/status is published: "
                "give the tracker's name with --tracker /namespace/name"
            )
        spin(LONGEST_SPIN)


def _play_and_record(
    player: Player, recorder: Recorder, spin: Spin, rate: float, stop: StopRequest
) -> list[int]:
    """Play to the end and wait for the last answer; return the images' stamps, ns."""
    stamps: list[int] = []
    with tqdm(total=player.bag.frames, desc="play", unit="frame", delay=2) as progress:
        for recorded in player.in_real_time(spin, rate, stop):
            if recorded.topic == player.bag.image_topic:
                stamps.append(header_stamp(recorded.cdr))
                progress.update()
    last_news, answers = time.monotonic(), len(recorder.answered)
    while not stop and stamps and stamps[-1] not in recorder.answered:
        spin(LONGEST_SPIN)
        if len(recorder.answered) > answers:
            last_news, answers = time.monotonic(), len(recorder.answered)
        if time.monotonic() - last_news > LAST_ANSWER:
            break
    return stamps


def main(argv: Sequence[str] | None = None) -> int:
    """Command line."""
    own, ros = split_ros_arguments(argv)
    parser = command("play", __doc__, EXAMPLE)
    add_bag(parser, out="out/play")
    parser.add_argument("--rate", type=float, default=1.0, help="2 plays twice as fast")
    parser.add_argument("--tracker", default=DEFAULT_TRACKER, help="the tracker node's full name")
    parser.add_argument("--no-box", action="store_true", help="leave out the bag's own init box")
    parser.add_argument("--now", action="store_true", help="stamp all with the time of the play")
    parser.add_argument("--wait", type=float, default=WAIT, help="s to wait for the tracker")
    options = parser.parse_args(own)
    folder = ResultsFolder(options.out)
    try:
        with BagReader(options.bag, options.image_topic) as bag, StopRequest() as stop:
            folder.clear()
            stamps = play(
                bag,
                folder.bag,
                stop,
                tracker=options.tracker,
                rate=options.rate,
                init=options.init,
                wait=options.wait,
                without_box=options.no_box,
                now=options.now,
                ros_arguments=ros,
            )
            summary = write_report(bag, stamps, folder, tracker=options.tracker)
    except (OSError, ValueError, NobodyListensError) as error:
        print(f"play: {error}", file=sys.stderr)
        return 1
    print("\n".join([*summary.lines(), f"results   {folder.path}"]))
    return INTERRUPTED if stop else 0


if __name__ == "__main__":
    sys.exit(main())
