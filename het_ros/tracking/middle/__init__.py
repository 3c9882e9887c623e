# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Middle layer: the votes together say where the target is and how large."""
