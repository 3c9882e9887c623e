# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bags in, results out: make a bag, play it to a running tracker, replay it, look at the answers.

Each command is an executable as well: ``ros2 run het_ros play``, ``run``, ``replay``...
"""
