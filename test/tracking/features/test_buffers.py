# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np

from het_ros.tracking.features.buffers import Buffers


def test_what_nobody_holds_is_used_again():
    buffers = Buffers()
    address = buffers.empty((30, 40), np.float32).ctypes.data
    assert buffers.empty((30, 40), np.float32).ctypes.data == address
    assert len(buffers._arrays) == 1


def test_what_somebody_holds_is_not():
    buffers = Buffers()
    views = [lambda a: a, lambda a: a[3:], lambda a: a.T, lambda a: a.reshape(-1)[::2], memoryview]
    held = [view(buffers.empty((30, 40), np.float64)) for view in views]
    arrays = [np.asarray(each) for each in held]
    for number, array in enumerate(arrays):
        array[...] = number
    buffers.empty((30, 40), np.float64)[...] = -1
    for number, array in enumerate(arrays):
        np.testing.assert_array_equal(array, number)


def test_another_shape_or_kind_gets_another_array():
    buffers = Buffers()
    first = buffers.empty((4, 5), np.float64)
    first[...] = 7
    for shape, dtype in (((5, 4), np.float64), ((4, 5), np.float32), ((4, 5), np.float64)):
        other = buffers.empty(shape, dtype)
        assert (other.shape, other.dtype) == (shape, dtype)
        assert not np.shares_memory(first, other)
    assert (first == 7).all()


def test_what_was_sealed_can_be_written_when_it_is_given_out_again():
    buffers = Buffers()
    buffers.empty((4, 5), np.float64).setflags(write=False)
    buffers.empty((4, 5), np.float64)[...] = 1
