# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Figures that can be checked: trackers, sequences, protocols, scores and reports.

The way of a run: ``readers`` find the sequences, ``trackers`` build what is compared,
``protocols`` lay out where runs start, ``jobs`` run them through ``cache`` and joblib,
``metrics``, ``state_metrics`` and ``summary`` score what came back, ``timing`` measures speed,
``report`` and ``video`` show it. ``cli`` is the executable ``evaluate``.

A tracker is handed images and one box. The ground truth stays with the scorer: it is neither in
a :class:`~het_ros.evaluation.sequences.Frames` nor in a job.
"""
