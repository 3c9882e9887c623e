# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The trackers here under tools of the field that are not ours: GOT-10k's toolkit and VOT's.

They need the extra ``harnesses``, in an environment of its own.
"""
