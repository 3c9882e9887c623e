# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import runpy

import pytest
from evaluation.doubles import write_sequence

from het_ros.evaluation import fitted_file
from het_ros.tools import fit
from het_ros.tracking import fitted
from het_ros.tracking.top.confidence import Features, probability

pytest.importorskip("sklearn")


@pytest.fixture
def two_sequences(tmp_path):
    """A square that moves and vanishes, twice."""
    for name, step in (("left", 2), ("right", 3)):
        boxes = [(60 - step * i, 20, 14, 14) if i < 12 else None for i in range(18)]
        write_sequence(tmp_path / "data" / name, boxes, image=(64, 96))
    return tmp_path / "data"


def test_two_runs_write_the_same_file(two_sequences, tmp_path, capsys):
    out = tmp_path / "out" / "fitted.py"
    asked = ["--data", str(two_sequences), "--seeds", "2", "--off", "1", "--scenes", "0"]
    asked += ["--jobs", "1", "--out", str(out)]
    assert fit.main(asked) == 0
    first = out.read_bytes()
    said = capsys.readouterr()
    assert "without_network, held out: calibration error" in said.out
    assert "with_network stays as it is" in said.err
    out.unlink()
    assert fit.main(asked) == 0
    assert out.read_bytes() == first

    names = runpy.run_path(str(out))
    assert len(names["FITTED"].without_network) == 7
    assert names["FITTED"].with_network == fitted.FITTED.with_network, "nothing was fitted to it"
    assert names["RECORDED_WITH"] == fitted.RECORDED_WITH
    described = " ".join(names["__doc__"].split())
    assert "102 frames of 6 runs, without a network, of 2 sequences" in described
    assert "left right." in described
    assert "calibration error 0." in described


def test_only_what_is_asked_for_is_written(two_sequences, tmp_path, capsys):
    out = tmp_path / "fitted.py"
    asked = ["--data", str(two_sequences), "--seeds", "1", "--off", "0", "--scenes", "0"]
    asked += ["--jobs", "1", "--out", str(out)]
    assert fit.main([*asked, "--only", "without_network"]) == 0
    assert runpy.run_path(str(out))["FITTED"] != fitted.FITTED
    out.unlink()
    assert fit.main([*asked, "--only", "with_network"]) == 2
    assert "nothing can be fitted: " in capsys.readouterr().err
    assert not out.exists()


def test_a_new_date_alone_does_not_change_the_file(tmp_path):
    file = tmp_path / "fitted.py"
    one, other = (
        fitted_file.text({}, fitted.FITTED, fitted.RECORDED_WITH, "Data: none.", date)
        for date in ("2026-01-01", "2026-01-02")
    )
    assert fitted_file.write(file, one)
    assert not fitted_file.write(file, other)
    assert file.read_text() == one
    assert fitted_file.write(file, other.replace("none", "some"))


def test_the_code_uses_the_file():
    known = Features(0.8, 1.2, 1.0, 0.4, 0.1, 0.2)
    assert probability(known) == probability(known, calibration=fitted.FITTED)


def test_one_clear_line_where_it_cannot_run(tmp_path, capsys):
    assert fit.main(["--data", str(tmp_path / "none")]) == 2
    assert capsys.readouterr().err.startswith("fit: ")
