# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How an executable starts: its arguments, and signals from its first import to its end."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Any, TypeVar

Given = TypeVar("Given")


@contextmanager
def ended_by_ctrl_c() -> Iterator[None]:
    """Ctrl-C ends the process at once, as SIGTERM does; for imports, before rclpy takes over.

    Python raises KeyboardInterrupt instead, and OpenCV's import swallows it: the tracker would
    start and run on.
    """
    if threading.current_thread() is not threading.main_thread():
        yield  # signals are the main thread's
        return
    before = signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


class CtrlC:
    """While it is entered, Ctrl-C raises nothing, however often it comes.

    rclpy shuts its context down at SIGINT, and so a node that spins ends. A KeyboardInterrupt
    besides would come anywhere: a second one in the middle of taking the node away.

    Attributes:
        asked: whether it came.
    """

    def __init__(self) -> None:
        self.asked = False
        self._before: Any = None

    def __enter__(self) -> CtrlC:
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._on_signal)
        return self

    def __exit__(self, *_: object) -> None:
        # Once it came the process is about to end, and the last line is no time for a traceback.
        if self._before is not None:
            signal.signal(signal.SIGINT, signal.SIG_IGN if self.asked else self._before)

    def _on_signal(self, number: int, frame: FrameType | None) -> None:
        self.asked = True


def own_arguments(argv: Sequence[str]) -> list[str]:
    """The arguments that are not ROS's, without the program's name.

    Raises:
        ValueError: ROS's cannot be read.
    """
    from rclpy.utilities import remove_ros_args

    return list(_in_one_line(lambda: remove_ros_args(list(argv)))[1:])


def start_ros(argv: Sequence[str]) -> None:
    """rclpy.init with a process's arguments.

    Raises:
        ValueError: ROS's arguments are wrong.
    """
    import rclpy

    _in_one_line(lambda: rclpy.init(args=list(argv)))


def _in_one_line(work: Callable[[], Given]) -> Given:
    """What ``work`` gives; its errors, of a private module, as one line without source files."""
    try:
        return work()
    except RuntimeError as error:
        raise ValueError(str(error).partition(", at /")[0].splitlines()[0]) from None
