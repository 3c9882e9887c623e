# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What votes for the places of a target: the bottom layer."""
