# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A call that is carried out beside the caller's own work, where a second processor is allowed."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, TypeVar

Answer = TypeVar("Answer")


class SecondThread:
    """One thread of its own for one call at a time; it ends with this object or the interpreter.

    Copies and pickles take no thread along: they start their own.

    Args:
        allowed: whether there may be a second thread at all.
    """

    def __init__(self, allowed: bool) -> None:
        self._allowed = allowed
        self._executor: ThreadPoolExecutor | None = None
        self._process = 0

    def begin(self, function: Callable[..., Answer], *arguments: Any) -> Callable[[], Answer]:
        """Begin a call; what is handed back waits for its answer, and raises what it raised.

        Where one processor alone may be used the call is made when its answer is asked for.
        """
        if not (self._allowed and processors() > 1):
            return partial(function, *arguments)
        if self._executor is None or self._process != os.getpid():  # a fork has no threads
            self._executor = ThreadPoolExecutor(1, thread_name_prefix="second")
            self._process = os.getpid()
        return self._executor.submit(function, *arguments).result

    def __reduce__(self) -> tuple[type[SecondThread], tuple[bool]]:
        return SecondThread, (self._allowed,)


def processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
