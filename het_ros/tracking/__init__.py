# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The Hierarchical Ensemble Tracker, one module a layer, without ROS.

The way of a frame is the order of reading: ``channels``, ``compressive``, ``base_ensembles``,
``combination``, ``motion``; ``tracker`` joins them.
"""
