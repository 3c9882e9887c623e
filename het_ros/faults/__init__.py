# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What breaks robots: streams with faults, too much of everything, hours. Measured on the node.

``soak`` runs it for long, ``overload`` faster than it can, ``flood`` with what others may send,
``stress`` with both processors loaded; ``disturb`` makes bad streams of good ones.
"""
