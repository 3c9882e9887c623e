# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The field's own harnesses; they need the extra `harnesses`."""

import subprocess
import sys
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from het_ros.evaluation import cli
from het_ros.evaluation.harnesses import vot_workspace

from ..doubles import Oracle, Scripted, spec, write_sequence


@pytest.fixture
def walk(tmp_path):
    return write_sequence(tmp_path / "data" / "walk", [(5 + 2 * i, 12, 14, 16) for i in range(12)])


def oracle(truth, seed):
    return Oracle(truth, seed)


def test_the_adapter_counts_pixels_as_the_data_does_and_gives_bgr(walk):
    toolkit = pytest.importorskip("het_ros.evaluation.harnesses.got10k_toolkit")
    tracker = toolkit.Got10kTracker(spec("o", partial(oracle, walk.truth)), first_pixel=1)
    images = [walk.frames[row][:, :, ::-1] for row in range(3)]
    tracker.init(images[0], walk.truth[0] + (1, 1, 0, 0))
    for row in (1, 2):
        np.testing.assert_allclose(tracker.update(images[row]), walk.truth[row] + (1, 1, 0, 0))


def test_got10ks_toolkit_gives_our_figures_on_the_same_boxes(walk, tmp_path, capsys):
    toolkit = pytest.importorskip("het_ros.evaluation.harnesses.got10k_toolkit")
    out = tmp_path / "out"
    base = ["--data", str(tmp_path / "data"), "--out"]
    options = [*base, str(out), "--trackers", "identity", "--timing", "0", "--quiet"]
    assert cli.main(options) == 0
    capsys.readouterr()
    assert toolkit.main([*base, str(tmp_path / "g"), "--evaluated", str(out)]) == 0
    line = capsys.readouterr().out.splitlines()[-1]
    name, auc, p20, apart = line.split()
    assert name == "identity"
    assert len(set(auc.split("/"))) == len(set(p20.split("/"))) == 1
    assert float(apart) < 0.001


def test_the_vot_process_starts_on_the_toolkits_region_and_answers_each_frame(walk):
    process = pytest.importorskip("het_ros.evaluation.harnesses.vot_tracker")
    status, sent = process.TraxStatus, []

    def image(row):
        return {"color": SimpleNamespace(path=lambda: walk.frames.files[row])}

    start = process.Rectangle.create(*walk.truth[0])
    requests = iter(
        [
            SimpleNamespace(type=status.INITIALIZE, image=image(0), objects=[(start, {})]),
            SimpleNamespace(type=status.FRAME, image=image(1)),
            SimpleNamespace(type=status.QUIT, image=None),
        ]
    )
    server = SimpleNamespace(wait=lambda: next(requests), status=sent.append)
    process.serve(server, Scripted([None, walk.truth[1]]), 1 / 30)
    found = [objects[0][0].bounds() for objects in sent]
    np.testing.assert_allclose(found, walk.truth[:2])


def test_the_workspace_has_sequences_stack_and_trackers(walk, tmp_path):
    out = tmp_path / "vot"
    vot_workspace.write([walk], {"still": ["identity"]}, out)
    assert (out / "sequences" / "list.txt").read_text() == "walk\n"
    lines = (out / "sequences" / "walk" / "groundtruth.txt").read_text().splitlines()
    assert [float(v) for v in lines[1].split(",")] == walk.truth[1].tolist(), "counted from 0"
    assert len(list((out / "sequences" / "walk" / "color").iterdir())) == 12
    assert "vot_tracker identity" in (out / "trackers.ini").read_text()


def test_vots_toolkit_runs_a_tracker_of_ours(walk, tmp_path):
    pytest.importorskip("vot")
    out = tmp_path / "vot"
    vot_workspace.write([walk], {"still": ["identity"]}, out)
    command = [sys.executable, "-m", "vot", "evaluate", "--workspace", str(out)]
    subprocess.run([*command, "--experiments", "onepass", "still"], check=True, cwd=tmp_path)
    assert any((out / "results" / "still" / "onepass" / "walk").glob("walk_001.*"))
