# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page on which a target is picked and watched in a browser, and the server behind it.

One way: ``messages``, ``pictures`` <- ``discovery``, ``watch``, ``recordings`` <- ``bridge``
(ROS) and ``client`` <- ``server`` (HTTP) <- ``main``, the executable. The server takes any bridge,
so that the page can be tried on a recorded stream without ROS.
"""
