# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json

import pytest

from het_ros.bench import cli, report
from het_ros.bench.figures import REQUIRED, lookup
from het_ros.bench.node import NodeCaseError
from het_ros.bench.plots import plots

TIMES = {"p50_ms": 2.0, "p95_ms": 3.0, "p99_ms": 4.0}
NODE = {
    "sent": 300, "dropped": 1, "rate": 30.0, "latency": TIMES, "own": TIMES, "cpu_share": 0.25,
    "rss_mb": 200.0,
}  # fmt: skip


def a_bench():
    trackers = {
        name: TIMES | {"het_is_faster_by": 3.2, "paper_is_faster_by": 1.0}
        for name in ("het", "csrt")
    }
    curve = {"cases": [{"name": "a", "size": 1, "p50_ms": 2.0},
                       {"name": "b", "size": 2, "p50_ms": 2.0}], "exponent": 0.0}  # fmt: skip
    floor = dict.fromkeys(
        ("window_ms", "integrals_ms", "product_ms", "learning_product_ms", "total_ms", "frame_ms"),
        0.1,
    )
    return {
        "date": "2026-01-02",
        "machine": dict.fromkeys(("cpu", "system", "python", "numpy", "opencv"), "x"),
        "load": {"before": 0.5, "after": 1.5},
        "core": TIMES
        | {
            "trackers": trackers, "floor": floor, "absent_peers": ["kcf"], "frames": 4,
            "sequences": {"street": {}}, "p99_over_p50": 2.5, "p99_over_p50_by_sequence": 1.2,
            "speed_over_csrt": 3.2, "paper_speed_over_csrt": 1.0, "ratio_to_floor": 20.0,
            "ratio_to_floor_with_learning": 10.0, "frame_allocations_mb": 2.0,
        },
        "stages": {"het": dict.fromkeys([*report.STAGES, "rest"], 0.5)},
        "scaling": dict.fromkeys(("target", "image", "sub_patches", "features"), curve)
        | {"target_factor": 1.1, "image_factor": 1.6},
        "node": {"1080p30": NODE | {"one_process": NODE, "core": TIMES, "added_p95_ms": 0.5}},
        "start": {
            "seconds": 1.5, "rss_mb": 150.0, "imports": {"numpy": {"seconds": 0.1, "rss_mb": 9.0}},
        },
    }  # fmt: skip


def test_the_report_tells_what_is_kept_and_what_is_not(tmp_path):
    bench = a_bench()
    text = report.write(bench, plots(bench), tmp_path).read_text()
    assert "| speed over CSRT, default | 3.20 | at least 3 | yes |" in text
    assert "| p99 over p50 of a frame | 2.50 | at most 2 | **no** |" in text
    assert "| frames dropped at 1080p, 30 frames/s | 1 | at most 0 | **no** |" in text
    assert "Not in this OpenCV: kcf." in text
    assert "het-network is left out: name the networks' folder" in text
    assert "| `numpy` | 0.10 | 9 |" in text
    for name in ("core", "stages", "scaling", "node"):
        assert f"![{name}]({name}.png)" in text
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_the_report_tells_what_a_network_costs():
    bench = a_bench()
    bench["core"] |= {
        "network": {"speed_over_csrt": 2.61, "time_over_slower": 1.25}, "processors": 2,
    }  # fmt: skip
    text = report.text(bench)
    assert "| speed over CSRT, with a network | 2.61 | at least 2.5 | yes |" in text
    assert "With a network it is 2.61 times as fast as CSRT." in text
    assert "(2 processors may be used) a frame takes 1.25 times as long" in text


def test_the_documentation_is_written_in_its_place_only(tmp_path):
    page = tmp_path / "PERFORMANCE.md"
    page.write_text("# Cost\n<!-- bench -->\nearlier\n<!-- /bench -->\nafter\n")
    report.update(page, a_bench())
    text = page.read_text()
    assert text.startswith("# Cost\n<!-- bench -->\n2026-01-02;")
    assert text.endswith("\n\n<!-- /bench -->\nafter\n")
    assert "earlier" not in text


def test_a_page_without_a_place_is_refused(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("nothing")
    with pytest.raises(ValueError, match="<!-- bench -->"):
        report.update(page, a_bench())


def test_a_run_of_some_parts_writes_what_it_measured(tmp_path):
    arguments = ["--out", str(tmp_path), "--quick", "--quiet", "--frames", "3"]
    assert cli.main([*arguments, "--parts", "core"]) == 0
    bench = json.loads((tmp_path / "bench.json").read_text())
    assert "node" not in bench
    assert lookup(bench, "core.p50_ms") > 0
    assert "| frames dropped at 1080p, 30 frames/s | - |" in (tmp_path / "report.md").read_text()


def test_what_other_parts_measured_stays_when_one_fails(tmp_path, monkeypatch, capsys):
    def no_node(*_):
        raise NodeCaseError("no ROS here")

    monkeypatch.setattr(cli, "node", no_node)
    monkeypatch.setattr(cli, "scaling", lambda *_: a_bench()["scaling"])
    assert cli.main(["--out", str(tmp_path), "--quick", "--parts", "scaling,node"]) == 2
    assert "no ROS here" in capsys.readouterr().err
    bench = json.loads((tmp_path / "bench.json").read_text())
    assert lookup(bench, "scaling.target_factor") == 1.1
    assert (tmp_path / "report.md").is_file()


def test_what_is_wrong_is_said(tmp_path, capsys):
    assert cli.main(["--out", str(tmp_path), "--data", str(tmp_path / "none")]) == 2
    assert "is not a folder" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        cli.main(["--out", str(tmp_path), "--parts", "soul"])
    assert "no part soul" in capsys.readouterr().err


def test_the_bench_of_the_test_has_every_required_figure():
    assert all(lookup(a_bench(), name) is not None for name in REQUIRED)
