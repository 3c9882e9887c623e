# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import math

import numpy as np
import pytest

from het_ros.bench import promises
from het_ros.bench.figures import (
    REQUIRED,
    exponent,
    factor,
    lookup,
    missing,
    percentiles,
    plain,
    speed_over,
)

NAN = float("nan")


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [
        ([0.002] * 5, (2, 2, 2)),
        (np.arange(101) / 1e3, (50, 95, 99)),
        ([NAN, 0.001, NAN], (1, 1, 1)),
    ],
)
def test_percentiles_are_of_the_measured_times_in_ms(seconds, expected):
    found = percentiles(seconds)
    assert [found[f"p{p}_ms"] for p in (50, 95, 99)] == pytest.approx(expected)


def test_percentiles_of_nothing_are_nan():
    assert all(math.isnan(value) for value in percentiles([NAN]).values())


def test_speed_is_the_median_of_the_sequences_not_of_all_frames():
    ours = [[1.0, 1.0, 9.0], [1.0], [1.0]]
    theirs = [[2.0, 2.0, 2.0], [4.0], [100.0]]
    assert speed_over(ours, theirs) == 4


@pytest.mark.parametrize(
    ("theirs", "expected"), [([[NAN, 2.0], [NAN]], 2.0), ([[NAN], [NAN]], None)]
)
def test_where_a_peer_failed_there_is_no_ratio(theirs, expected):
    found = speed_over([[1.0, 1.0][: len(t)] for t in theirs], theirs)
    assert math.isnan(found) if expected is None else found == expected


@pytest.mark.parametrize("k", [-1.0, 0.0, 0.5, 2.0])
def test_exponent_of_a_power_law(k):
    sizes = [3.0, 10.0, 31.0, 500.0]
    assert exponent(sizes, [7 * s**k for s in sizes]) == pytest.approx(k, abs=1e-9)


def test_factor_is_largest_over_smallest():
    assert factor([2.0, 8.0, 4.0]) == 4


def nested(values):
    """A bench with these figures."""
    bench = {}
    for name, value in values.items():
        *parts, last = name.split(".")
        place = bench
        for part in parts:
            place = place.setdefault(part, {})
        place[last] = value
    return bench


def test_a_bench_with_every_figure_misses_none():
    assert missing(nested(dict.fromkeys(REQUIRED, 1.0))) == []


@pytest.mark.parametrize("broken", [None, NAN, "3", {}])
def test_what_is_no_number_is_missing(broken):
    bench = nested(dict.fromkeys(REQUIRED, 1) | {"node.1080p30.dropped": broken})
    assert missing(bench) == ["node.1080p30.dropped"]


def test_missing_of_nothing_is_everything():
    assert missing({}) == list(REQUIRED)


def test_lookup_stops_where_there_is_nothing():
    assert lookup({"core": 3}, "core.p50_ms") is None


def test_plain_has_no_nan():
    assert plain({"a": [NAN, {"b": 2}], "c": math.inf}) == {"a": [None, {"b": 2}], "c": None}


@pytest.mark.parametrize(("value", "kept"), [(3.0, True), (2.9, False), (None, None), (NAN, None)])
def test_a_promise_is_kept_broken_or_not_measured(value, kept):
    bench = nested({"core.speed_over_csrt": value})
    assert promises.PROMISES[0].kept(bench) is kept


def test_every_promise_is_on_a_figure_that_a_bench_has():
    figures = {promise.figure for promise in promises.PROMISES}
    # Those are of a bench that was given networks.
    with_networks = {figure for figure in figures if figure.startswith("core.network.")}
    assert len(with_networks) == 2
    assert figures - with_networks <= set(REQUIRED)
