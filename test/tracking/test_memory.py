# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.tracking.memory import Memory

FRAMES = [np.random.default_rng(k).normal(size=(3, 2)) for k in range(6)]


@pytest.mark.parametrize(("rate", "share"), [(0.1, 0.0), (0.1, 0.3), (1.0, 0.0), (0.5, 1.0)])
def test_means_are_those_of_the_formula(rate, share):
    memory = Memory(rate, share)
    wanted = FRAMES[0]
    for frame in FRAMES:
        memory.learn(frame, 2 * frame)
        mixed = (1 - share) * frame + share * FRAMES[0]
        wanted = (1 - rate) * wanted + rate * mixed
        np.testing.assert_allclose(memory.values[0], wanted, rtol=1e-12)
        np.testing.assert_allclose(memory.values[1], 2 * wanted, rtol=1e-12)


def test_who_has_learnt_nothing_is_false():
    memory = Memory(0.1, 0.1)
    assert not memory
    memory.learn(FRAMES[0])
    assert memory


def test_what_is_learnt_stays_the_caller_s():
    memory, first = Memory(0.5, 0.5), FRAMES[0].copy()
    memory.learn(first)
    memory.learn(FRAMES[1])
    np.testing.assert_array_equal(first, FRAMES[0])


@pytest.mark.parametrize("dtype", [np.float32, np.complex64, np.float64])
def test_what_is_remembered_keeps_its_kind(dtype):
    memory = Memory(0.1, 0.1)
    for frame in FRAMES:
        memory.learn(frame.astype(dtype))
    assert memory.values[0].dtype == dtype
