# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Signals that come while an executable still starts."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


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
