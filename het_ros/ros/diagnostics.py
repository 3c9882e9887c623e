# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""``/diagnostics``: how the node does, once a second, for rqt_robot_monitor and the like."""

from __future__ import annotations

from collections import Counter, deque

import numpy as np
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Header

from het_ros.ros.status import level_of
from het_ros.tracking.estimate import State

LATENCIES = 300  # the newest so many make the percentiles
# What became of the images.
COUNTED = ("processed", "duplicate", "late", "unreadable", "skipped", "dropped")


class Health:
    """Rates and latencies since the last report, totals since the start."""

    def __init__(self) -> None:
        self._latencies: deque[float] = deque(maxlen=LATENCIES)
        self._fresh = 0

    def processed(self, latency: float) -> None:
        """Count a frame that took ``latency`` s from its arrival to its outputs."""
        self._latencies.append(latency)
        self._fresh += 1

    def report(
        self,
        name: str,
        camera: str,
        now: Time,
        seconds: float,
        counts: Counter[str],
        state: State,
        enabled: bool,
        trouble: str = "",
    ) -> DiagnosticArray:
        """One status, with the level that ``~/status`` has.

        Args:
            name: the node's full name.
            camera: frame_id of the images.
            now: stamp.
            seconds: since the last report.
            counts: frames by what became of them, since the start.
            state: of the track.
            enabled: whether images are processed at all.
            trouble: why none is processed, where that has lasted; else empty.
        """
        rate = self._fresh / seconds if seconds > 0 else 0.0
        self._fresh = 0
        level, text = level_of(state), f"{state.value}, {rate:.1f} frames/s"
        if not enabled:
            level, text = DiagnosticStatus.OK, "disabled or not active"
        elif rate == 0:
            text = f"{state.value}: {trouble}" if trouble else "no images"
            level = level_of(state, trouble=True)
        values = {"state": state.value, "rate_hz": f"{rate:.2f}"}
        for key in COUNTED:
            values[key] = str(counts[key])
        for percent in (50, 95, 99):
            part = np.percentile(self._latencies, percent) if self._latencies else 0.0
            values[f"latency_p{percent}_ms"] = f"{1e3 * part:.2f}"
        status = DiagnosticStatus(
            level=level,
            name=f"{name.lstrip('/')}: tracking",
            message=text,
            hardware_id=camera,
            values=[KeyValue(key=key, value=value) for key, value in values.items()],
        )
        return DiagnosticArray(header=Header(stamp=now), status=[status])
