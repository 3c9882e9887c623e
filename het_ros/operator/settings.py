# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The parameters of a tracker that are worth a change while it runs, as their descriptors tell."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor, ParameterType
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import Parameter, parameter_value_to_python

from het_ros.operator.ros_thread import RosThread

RING = "ring_seconds"
# Those that a tracker does not have are left out.
WORTH_IT = (
    "lost_after",
    "max_gap",
    "search_radius",
    "growth_limit",
    "seed",
    "white_level",
    RING,
    "ring_megabytes",
)


class LiveSettings:
    """Parameters of trackers, asked for from the server's loop."""

    def __init__(self, ros: RosThread) -> None:
        self._ros = ros
        self._before: dict[str, float] = {}

    async def read(self, tracker: str) -> list[dict[str, Any]]:
        """Name, value, description and range of each parameter; empty where nobody answers."""
        try:
            listed = await self._of(tracker, ListParameters, "list", ListParameters.Request())
            names = [name for name in WORTH_IT if name in listed.result.names]
            asked = DescribeParameters.Request(names=names)
            described = await self._of(tracker, DescribeParameters, "describe", asked)
            got = await self._of(tracker, GetParameters, "get", GetParameters.Request(names=names))
        except TimeoutError:
            return []
        return [
            _described(descriptor, parameter_value_to_python(value))
            for descriptor, value in zip(described.descriptors, got.values, strict=False)
            if not descriptor.read_only
        ]

    async def write(self, tracker: str, name: str, value: bool | float) -> str:
        """Set one parameter that :meth:`read` gives.

        Raises:
            ValueError: it is none of them, or the tracker refuses, in the tracker's words.
            TimeoutError: nobody answers.
        """
        if name not in WORTH_IT:
            raise ValueError(f"{name} is not changed from here")
        asked = GetParameters.Request(names=[name])
        (before,) = (await self._of(tracker, GetParameters, "get", asked)).values
        if before.type == ParameterType.PARAMETER_DOUBLE and not isinstance(value, bool):
            value = float(value)  # JSON writes 3.0 as 3
        parameter = Parameter(name, value=value).to_parameter_msg()
        asked = SetParameters.Request(parameters=[parameter])
        (result,) = (await self._of(tracker, SetParameters, "set", asked)).results
        if not result.successful:
            raise ValueError(result.reason)
        return result.reason or f"{name} is {value}"

    async def raise_ring(self, tracker: str, seconds: float) -> None:
        """Let a tracker keep images for so long, if it keeps them for less."""
        known = {p["name"]: p["value"] for p in await self.read(tracker)}
        if RING in known and known[RING] < seconds:
            self._before.setdefault(tracker, known[RING])
            with suppress(OSError, ValueError):
                await self.write(tracker, RING, seconds)

    async def restore_ring(self, tracker: str, there: bool) -> None:
        """Set back what :meth:`raise_ring` raised, if the tracker is still there."""
        before = self._before.pop(tracker, None)
        if before is not None and there:
            with suppress(OSError, ValueError):
                await self.write(tracker, RING, before)

    async def _of(self, tracker: str, kind: Any, verb: str, request: Any) -> Any:
        return await self._ros.call(kind, f"{tracker}/{verb}_parameters", request)


def _described(descriptor: ParameterDescriptor, value: Any) -> dict[str, Any]:
    """One parameter as the page takes it; low and high are None where there is no range."""
    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    low, high = (ranges[0].from_value, ranges[0].to_value) if ranges else (None, None)
    return {
        "name": descriptor.name,
        "value": value,
        "help": descriptor.description,
        "low": low,
        "high": high,
        "whole": descriptor.type == ParameterType.PARAMETER_INTEGER,
    }
