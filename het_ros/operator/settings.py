# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The parameters of a tracker that are worth a change while it runs, as their descriptors tell."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import Parameter, ParameterDescriptor, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import Parameter as RclpyParameter
from rclpy.parameter import parameter_value_to_python

from het_ros.operator.messages import Answer
from het_ros.operator.ros_thread import RosThread

BOOL = ParameterType.PARAMETER_BOOL
INTEGER, DOUBLE = ParameterType.PARAMETER_INTEGER, ParameterType.PARAMETER_DOUBLE
RING = "ring_seconds"
# Those that a tracker does not have are left out.
WORTH_IT = (
    "lost_after",
    "max_gap",
    "hidden",
    "return_probability",
    "search_radius",
    "growth_limit",
    "camera_motion",
    "rotation",
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

    async def write(self, tracker: str, name: str, value: Any) -> Answer:
        """Set one parameter that :meth:`read` gives; a refusal has the tracker's words."""
        if name not in WORTH_IT:
            return Answer(False, f"{name} is not changed from here")
        try:
            asked = GetParameters.Request(names=[name])
            (before,) = (await self._of(tracker, GetParameters, "get", asked)).values
            after = _like(before, value)
            asked = SetParameters.Request(parameters=[Parameter(name=name, value=after)])
            (result,) = (await self._of(tracker, SetParameters, "set", asked)).results
        except (TimeoutError, ValueError) as error:
            return Answer(False, str(error))
        return Answer(result.successful, result.reason or f"{name} is {value}")

    async def raise_ring(self, tracker: str, seconds: float) -> None:
        """Let a tracker keep images for so long, if it keeps them for less."""
        known = {p["name"]: p["value"] for p in await self.read(tracker)}
        if RING in known and known[RING] < seconds:
            self._before.setdefault(tracker, known[RING])
            await self.write(tracker, RING, seconds)

    async def restore_ring(self, tracker: str) -> None:
        """Set back what :meth:`raise_ring` raised."""
        before = self._before.pop(tracker, None)
        if before is not None:
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
        "whole": descriptor.type == INTEGER,
    }


def _like(before: ParameterValue, value: bool | float) -> ParameterValue:
    """A value of the type that the parameter has; raises ValueError where it does not fit."""
    whole = isinstance(value, bool) or int(value) == value
    if (before.type == BOOL) is not isinstance(value, bool) or (
        before.type == INTEGER and not (whole and abs(value) < 2**63)
    ):
        raise ValueError(f"{value!r} is of another type than the parameter")
    if before.type == DOUBLE:
        value = float(value)
    elif before.type == INTEGER:
        value = int(value)
    return RclpyParameter("", value=value).get_parameter_value()
