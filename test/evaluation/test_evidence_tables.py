# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import re
from pathlib import Path

import numpy as np
import pytest

from het_ros.evaluation import evidence_tables

SEQUENCES = ("Woman", "Car1", "Dog", "elsewhere")


def velocity_of(**changes):
    ahead = {"stays": 0.4, "two_boxes": 0.3, "velocity": 0.2, "own": None}
    found = {
        **{"zero": 2.0, "differences": 4.0, "filter": 1.5, "published": 1.0},
        **{"change": 1.2, "filter_change": 0.9, "true_change": 0.6},
        **{"lag": 1.25, "filter_lag": 2.0, "within_95": 0.9, "ahead": {"0.1": ahead}},
        "frames": 50,
    }
    return found | changes


def tracker(auc, **more):
    figures = {"auc": float(np.mean(auc)), "fps": 100.0}
    figures["sequences"] = {
        name: {"auc": value, "p20": value / 2} for name, value in zip(SEQUENCES, auc, strict=True)
    }
    return figures | more


@pytest.fixture
def results():
    honest = {
        **{"confident": 0.5, "confident_off": None, "off": 0.0},
        **{"recall": 0.9, "published_auc": 0.6},
    }
    honesty = {
        "sequences": {"Woman": honest, "Car1": honest | {"confident_off": 0.1}},
        **{"longest_false_lost": 7, "calibration_error": 0.02},
        **{"precision": 0.7, "recall": 0.6, "f": 0.65, "threshold": 0.3},
    }
    moves = {"Woman": velocity_of(), "Dog": velocity_of(zero=0.2, lag=None)}
    het = tracker([0.8, 0.6, 0.4, 0.2], honesty=honesty, velocity=moves)
    peer = tracker([0.7, 0.7, 0.7, 0.7], fps=None)
    return {"sequences": list(SEQUENCES), "trackers": {"het": het, "peer": peer}}


def lines(table):
    return table.markdown().splitlines()


def test_in_short_shows_what_was_seen_first_apart_and_peers_in_the_order_of_their_worth(results):
    table = evidence_tables.in_short(results)
    assert lines(table)[0] == (
        "| tracker | AUC, seen in development first (2) | P20, seen in development first (2) "
        "| AUC, added later (1) | P20, added later (1) | frames/s |"
    )
    assert lines(table)[2:] == [
        "| peer | 0.700 ± 0.000 | 0.350 ± 0.000 | 0.700 | 0.350 | - |",
        "| het | 0.700 ± 0.100 | 0.350 ± 0.050 | 0.400 | 0.200 | 100 |",
    ]
    assert "Seen in development first: Woman, Car1." in table.note


def test_in_short_of_sequences_in_no_group_is_over_all(results):
    results["sequences"] = ["elsewhere"]
    for of in results["trackers"].values():
        of["sequences"] = {"elsewhere": of["sequences"]["elsewhere"]}
    assert "| AUC, all (1) |" in lines(evidence_tables.in_short(results))[0]


def test_groups(results):
    table = lines(evidence_tables.by_group(results, "auc", "AUC by group"))
    assert table[0] == "| sequences | peer | het |"
    assert "| all (4) | **0.700 ± 0.000** | 0.500 ± 0.129 |" in table
    assert "| animals and things (1) | **0.700** | 0.400 |" in table


def test_honesty_has_a_row_for_who_gives_a_score(results):
    table = lines(evidence_tables.honesty(results))
    assert table[2:] == [
        "| het | 0.500 ± 0.000 | 0.100 | 0.000 ± 0.000 | 0.900 ± 0.000 | 0.600 ± 0.000 | 7 "
        "| 0.700 | 0.600 | 0.650 | 0.300 | 0.020 |"
    ]


def test_velocity_over_all_and_over_what_moves(results):
    table = lines(evidence_tables.velocities(results))
    assert table[2].startswith("| het, all (2) | 1.10 ± 0.90 | 4.00 ± 0.00 |")
    assert table[3] == (
        "| het, moving (1) | 2.00 | 4.00 | 1.50 | 1.00 | 0.50 | 2.00 | 1.50 | 1.2 | 2.0 | 0.90 |"
    )


def test_velocity_by_sequence_marks_the_smallest_error(results):
    (table,) = evidence_tables.velocities_by_sequence(results)
    assert table.title == "Velocity of het by sequence"
    assert lines(table)[2:] == [
        "| Woman | 50 | 2.00 | 4.00 | 1.50 | **1.00** | 2.00 | 1.2 | 0.90 |",
        "| Dog | 50 | **0.20** | 4.00 | 1.50 | 1.00 | 2.00 | - | 0.90 |",
    ]


def test_prediction_beside_what_needs_no_tracker(results):
    table = lines(evidence_tables.predictions(results))
    expected = "| het | 0.1 | 0.400 ± 0.000 | 0.300 ± 0.000 | **0.200 ± 0.000** | - |"
    assert table[2:] == [expected]


def test_tables_without_rows_are_left_out(results):
    del results["trackers"]["het"]["honesty"], results["trackers"]["het"]["velocity"]
    titles = [table.title for table in evidence_tables.tables(results)]
    assert titles == ["In short", "AUC by group", "Precision at 20 px by group"]


OF_EVERY_RUN = {
    *("Trackers", "AUC by sequence", "Precision at 20 px by sequence", "AUC by attribute"),
    *("Did it know?", "Published figures beside ours"),
}


@pytest.mark.parametrize("page", ["README.md", "docs/RESULTS.md"])
def test_the_pages_ask_for_tables_that_there_are(results, page):
    text = (Path(__file__).parents[2] / page).read_text()
    asked = {
        title.strip()
        for place in re.findall("<!-- evaluate: (.*?) -->", text)
        for title in place.split(",")
    }
    given = {table.title for table in evidence_tables.tables(results)}
    assert asked
    assert asked <= given | OF_EVERY_RUN
