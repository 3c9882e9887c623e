# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A managed node whose parameters are the two tables, the node's and the tracker's."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from het_ros.ros.managed_node import ManagedNode
from het_ros.ros.parameters import NodeConfig, declare, read
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.parameter import parameters_of

OF_THE_TRACKER = {declared.name for declared in parameters_of(TrackerConfig)}


class TunedNode(ManagedNode):
    """Declares the parameters and refuses what does not fit; :meth:`tuned` takes what does.

    Attributes:
        settings: the node's parameters, as they are now.

    Args:
        name: node name.
        config: the tracker's defaults, under the parameters that are set.
        **options: of rclpy's Node.
    """

    def __init__(self, name: str, config: TrackerConfig | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        declare(self, NodeConfig())
        declare(self, config or TrackerConfig())
        self.settings = read(self, NodeConfig)
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._apply_parameters)

    @property
    def tracker_config(self) -> TrackerConfig:
        """The tracker's parameters, as they are now."""
        return read(self, TrackerConfig)

    def tuned(self) -> None:
        """Take new values, between two frames."""

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters as any node does; the answer says when they take effect.

        Raises:
            ParameterNotDeclaredException: as any node does.
        """
        result = super().set_parameters_atomically(parameter_list)
        later = [p.name for p in parameter_list if p.name in OF_THE_TRACKER]
        if result.successful and later:
            result.reason = f"{', '.join(later)}: takes effect with the next box"
            self.get_logger().info(result.reason)
        return result

    def _check_parameters(self, parameters: list[Parameter]) -> SetParametersResult:
        """Refuse values that do not fit, each alone or with the others, with the reason."""
        changed = {parameter.name: parameter.value for parameter in parameters}
        try:
            read(self, NodeConfig, **changed)
            read(self, TrackerConfig, **changed)
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply_parameters(self, _: list[Parameter]) -> None:
        self.settings = read(self, NodeConfig)
        self.tuned()
