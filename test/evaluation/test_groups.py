# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

from het_ros.evaluation import groups
from het_ros.evaluation.readers import read_sequences


def test_a_mean_is_one_over_sequences_with_its_standard_error():
    values = [0.1, 0.4, 0.5, 0.8]
    found = groups.mean(values)
    spread = np.sqrt(sum((v - 0.45) ** 2 for v in values) / 3)
    assert (found.value, found.count) == (pytest.approx(0.45), 4)
    assert found.error == pytest.approx(spread / 2)
    assert f"{found:.2f}" == "0.45 ± 0.14"
    assert f"{found:+.2f}" == "+0.45 ± 0.14"


def test_one_sequence_has_no_error_and_none_no_mean():
    assert groups.mean([0.5]) == groups.Mean(0.5, None, 1)
    assert f"{groups.mean([0.5]):.1f}" == "0.5"
    with pytest.raises(ValueError, match="at least one sequence"):
        groups.mean([])


def test_sequences_fall_into_groups_and_unnamed_ones_only_into_all():
    found = groups.grouped(["Woman", "DTB70-Gull1", "somewhere_else", "Car1"])
    assert found == {
        "all": ["Woman", "DTB70-Gull1", "somewhere_else", "Car1"],
        "seen in development first": ["Woman", "Car1"],
        "added later": ["DTB70-Gull1"],
        "people": ["Woman"],
        "vehicles": ["Car1"],
        "animals and things": ["DTB70-Gull1"],
        "from the ground": ["Woman", "Car1"],
        "from the air": ["DTB70-Gull1"],
    }
    assert next(iter(found)) == "all"
    assert groups.grouped(["elsewhere"]) == {"all": ["elsewhere"]}


def test_means_of_groups():
    found = groups.means({"Woman": 0.2, "Car1": 0.6, "elsewhere": 1.0})
    assert found["all"].value == pytest.approx(0.6)
    assert found["seen in development first"].value == pytest.approx(0.4)
    assert found["people"] == groups.Mean(0.2, None, 1)


def test_the_file_names_each_sequence_once_and_divides_them():
    rows = groups.FILE.read_text().splitlines()[1:]
    assert len({row.partition(",")[0] for row in rows}) == len(rows)
    found = groups.grouped(groups.known())
    sizes = {group: len(members) for group, members in found.items()}
    assert (sizes[groups.FIRST], sizes[groups.LATER]) == (17, 20)
    kinds = ("people", "riders", "faces", "vehicles", "animals and things")
    assert sum(sizes[kind] for kind in kinds) == sizes["all"]
    assert sizes["from the ground"] + sizes["from the air"] == sizes["all"]


def test_every_sequence_that_the_file_names_can_be_read(data):
    """Whoever has more sequences, or some of these, is no worse off."""
    here = {sequence.name for sequence in read_sequences(data)}
    if not set(groups.known()) <= here:
        pytest.skip(f"{data} holds some of the sequences only")
    for members in groups.grouped(here).values():
        assert set(members) <= here
