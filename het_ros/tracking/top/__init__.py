# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Top layer: motion, confidence, re-detection."""
