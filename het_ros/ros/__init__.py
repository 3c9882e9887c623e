# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The ROS shell around the tracker: conversions, parameters and the node, and no tracking.

``tracker_node`` is the node; ``session`` the life of one track without ROS; ``images`` and
``messages`` are pure conversions; ``stamps``, ``status`` and ``hints`` are what its name says.
"""
