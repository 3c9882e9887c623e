# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""Arrays of megabytes that are used again once nobody holds them.

A fresh array of that size every frame is memory that the system hands out, zeroed page by page,
and takes back each time: half of a frame's time. An array that somebody still holds, or a view of
it, is never handed out a second time.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

Array = NDArray[Any]


class Buffers:
    """Gives arrays whose contents are left over from before."""

    def __init__(self) -> None:
        self._arrays: list[Array] = []
        # Of an array that nothing but the list holds; counted, as Python's versions differ.
        self._unheld = _references([np.empty(1)], 0)

    def __reduce__(self) -> tuple[type[Buffers], tuple[()]]:
        """A copy begins with nothing."""
        return Buffers, ()

    def empty(self, shape: tuple[int, ...], dtype: DTypeLike) -> Array:
        """A writeable array that owns its memory and that nobody else holds.

        Arrays of another shape or dtype that nobody holds are given up.

        Args:
            shape: of the array.
            dtype: of the array.
        """
        found: Array | None = None
        kept: list[Array] = []
        for index in range(len(self._arrays)):
            held = _references(self._arrays, index) > self._unheld
            array = self._arrays[index]
            fits = array.shape == shape and array.dtype == np.dtype(dtype)
            if fits and not held and found is None:
                found = array
            if held or fits:
                kept.append(array)
        if found is None:
            found = np.empty(shape, dtype)
            kept.append(found)
        self._arrays = kept
        found.setflags(write=True)  # who held it last may have sealed it
        return found


def _references(arrays: list[Array], index: int) -> int:
    """References to an array of a list, of which its views hold one each."""
    return sys.getrefcount(arrays[index])
