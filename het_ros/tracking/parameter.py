# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""One declaration a parameter: default, range, unit and meaning in one place.

A configuration is a frozen dataclass whose fields are made with :func:`parameter`. The node's
declarations, the command line, the validation and the tables in the docs all read it back with
:func:`parameters_of`.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, cast

Value = bool | int | float | str | tuple[str, ...]


@dataclass(frozen=True)
class Parameter:
    """What is known of one field of a configuration.

    Attributes:
        name: the field's name.
        default: its default; its type is the parameter's type.
        doc: one line: what it does.
        unit: "px", "s", "rad"...; empty for pure numbers.
        low, high: inclusive range of a number, or None.
        choices: what a string (or each item of a tuple) may be; empty for anything.
        read_only: whether it stays fixed once a node runs.
    """

    name: str
    default: Value
    doc: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    read_only: bool = False

    def check(self, value: object) -> None:
        """Raise ValueError, saying what would be right, unless ``value`` fits."""
        kind = type(self.default)
        if kind is float and type(value) is int:
            value = float(value)
        if type(value) is not kind:
            raise ValueError(f"{self.name} takes a {kind.__name__}, not {value!r}")
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            self._check_range(value)
        for item in value if isinstance(value, tuple) else (value,):
            if self.choices and item not in self.choices:
                raise ValueError(f"{self.name} is one of {', '.join(self.choices)}, not {item!r}")

    def _check_range(self, value: float) -> None:
        low = -math.inf if self.low is None else self.low
        high = math.inf if self.high is None else self.high
        if not (math.isfinite(value) and low <= value <= high):
            raise ValueError(f"{self.name} lies in [{low:g}, {high:g}], {value!r} does not")


def parameter(
    default: Value,
    doc: str,
    *,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] = (),
    read_only: bool = False,
) -> Any:
    """A dataclass field that carries its own :class:`Parameter`."""
    declared = {
        "doc": doc,
        "unit": unit,
        "low": low,
        "high": high,
        "choices": choices,
        "read_only": read_only,
    }
    return dataclasses.field(default=default, metadata={"parameter": declared})


def parameters_of(configuration: type) -> tuple[Parameter, ...]:
    """The table of a configuration class, in the order of its fields."""
    return tuple(
        Parameter(name=f.name, default=cast(Value, f.default), **f.metadata["parameter"])
        for f in dataclasses.fields(configuration)
    )


def check_parameters(configuration: Any) -> None:
    """Check every field of a configuration; raise ValueError at the first that does not fit."""
    for declared in parameters_of(type(configuration)):
        declared.check(getattr(configuration, declared.name))
