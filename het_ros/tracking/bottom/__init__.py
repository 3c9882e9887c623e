# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bottom layer: base ensembles, each of which learns the target and votes for its place."""
