# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""How many cases a fuzz test tries, and how many it has tried."""

from __future__ import annotations

import os
from collections import Counter
from functools import wraps

from hypothesis import settings

COUNTS: Counter[str] = Counter()


def cases(short: int, **options) -> settings:
    """Settings of a test that tries ``short`` cases in CI, and as many as told by `make fuzz`."""
    number = int(os.environ.get("HET_FUZZ_CASES", short))
    return settings(settings.get_profile("fuzz"), max_examples=number, **options)


def counted(test):
    """A test whose cases are counted, to be put right above its function."""

    @wraps(test)
    def counting(*args, **kwargs):
        COUNTS[test.__name__] += 1
        return test(*args, **kwargs)

    return counting
