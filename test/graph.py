# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Nodes of a test, and where the installed executables are.

ROS is imported where it is used only, so that the core's tests run without it.
"""

from __future__ import annotations

import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
EXECUTABLES = ROOT / "install" / "het_ros" / "lib" / "het_ros"
PATIENCE = 60  # s: how long something that must happen may take on a busy machine


class Graph:
    """Nodes of one context, spun in this thread; invisible to the rest of the machine."""

    def __init__(self) -> None:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.nodes: list = []

    def add(self, node):
        """Take a node made with ``context=graph.context``; it is destroyed with the graph."""
        self.executor.add_node(node)
        return self.keep(node)

    def keep(self, node):
        """Destroy a node with the graph, but do not spin it."""
        self.nodes.append(node)
        return node

    def spin_until(self, happened, what: str = "what the test waits for") -> None:
        """Spin until ``happened()`` is true; fail when it does not happen at all."""
        assert self.spins_until(happened, PATIENCE), f"did not happen: {what}"

    def spins_until(self, happened, patience: float) -> bool:
        """Spin until ``happened()`` is true or for ``patience`` s; whether it happened."""
        end = time.monotonic() + patience
        while not happened():
            if time.monotonic() >= end:
                return False
            self.executor.spin_once(timeout_sec=0.02)
        return True

    def settle(self, rounds: int = 5) -> None:
        """Let everything that is on its way arrive."""
        for _ in range(rounds):
            self.executor.spin_once(timeout_sec=0.02)

    def close(self) -> None:
        self.executor.shutdown()
        for node in self.nodes:
            node.destroy_node()
        self.context.try_shutdown()
