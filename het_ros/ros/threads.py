# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How many processors a node takes."""

from __future__ import annotations

import cv2

try:
    from threadpoolctl import threadpool_limits
except ImportError:  # not everywhere to be had from apt
    threadpool_limits = None


def one_thread() -> None:
    """Let OpenCV and BLAS work in the calling thread alone, for the whole process.

    The images and products of a frame are so small that handing them to other threads takes
    longer than the work, and the other processors belong to the rest of the robot. Where
    threadpoolctl is not installed BLAS keeps its own setting: then start the node with
    OPENBLAS_NUM_THREADS=1.
    """
    cv2.setNumThreads(1)
    if threadpool_limits is not None:
        threadpool_limits(limits=1)
