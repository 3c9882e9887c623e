# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Every setting of the operator's server."""

from __future__ import annotations

from dataclasses import dataclass

from het_ros.tracking.parameter import check_parameters, parameter


@dataclass(frozen=True)
class OperatorConfig:
    """The parameters of the executable ``operator``.

    Raises:
        ValueError: a value is of the wrong type or outside its range.
    """

    host: str = parameter(
        "localhost", "address to listen on; 0.0.0.0 for every network, then with a token"
    )
    port: int = parameter(8642, "port to listen on; 0 takes a free one", low=0, high=65535)
    token: str = parameter("", "what clients have to know; empty makes one up where it is needed")
    max_clients: int = parameter(8, "more browsers are refused", low=1, high=1000)
    keep_seconds: float = parameter(
        20.0,
        "while somebody picks, the tracker's ring_seconds is raised to this; 0 leaves it alone",
        unit="s",
        low=0.0,
        high=60.0,
    )
    recordings: str = parameter("~/.ros/het_ros", "folder of the recordings")
    max_recording: float = parameter(
        1000.0, "a recording ends when it is as large as this", unit="MB", low=1.0, high=1e6
    )

    def __post_init__(self) -> None:
        check_parameters(self)

    @property
    def local(self) -> bool:
        """Whether only this machine can connect."""
        return self.host in ("localhost", "127.0.0.1", "::1")
