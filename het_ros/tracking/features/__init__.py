# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What one frame is turned into: a search window, its channels and its compressive features."""
