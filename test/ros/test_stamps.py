# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from het_ros.ros.stamps import SECOND, Order, StampGate


@pytest.mark.parametrize(
    "stamps, orders",
    [
        ([1.0, 1.1, 1.2], "NNN"),
        ([1.0, 1.0, 1.1], "NDN"),
        ([1.0, 1.2, 1.1, 1.3], "NNLN"),  # two frames that changed places
        ([1.0, 1.2, 1.1, 1.2], "NNLD"),
        ([9.0, 9.1, 1.0, 1.1], "NNJN"),  # a bag in a loop
        ([9.0, 8.0, 8.1], "NJN"),  # exactly jump_back
        ([9.0, 8.001, 8.1], "NLL"),
        ([0.0, 0.0], "ND"),
    ],
)
def test_order_of_stamps(stamps, orders):
    gate = StampGate(jump_back=1.0)
    letters = {"N": Order.NEXT, "D": Order.DUPLICATE, "L": Order.LATE, "J": Order.JUMP_BACK}
    assert [gate.take(round(s * SECOND)) for s in stamps] == [letters[o] for o in orders]
    assert gate.dropped[Order.DUPLICATE] == orders.count("D")
    assert gate.dropped[Order.LATE] == orders.count("L")
