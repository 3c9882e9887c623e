# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What a frame costs: the core beside its peers, as it scales, stage by stage; and the node."""
