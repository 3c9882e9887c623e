# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The bench in words: tables in Markdown for the report and for the documentation."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from het_ros.bench import promises
from het_ros.bench.stages import STAGES

Bench = Mapping[str, Any]
_PLACE = re.compile(r"(<!-- bench -->\n).*?(<!-- /bench -->)", re.DOTALL)
_CURVES = {
    "target": "target on the largest image",
    "image": "image, target 48x120",
    "sub_patches": "Q, number of sub-patches",
    "features": "m, number of features",
}


def write(bench: Bench, plots: Mapping[str, bytes], out: Path) -> Path:
    """Write ``out/report.md`` with its plots beside it; returns the file."""
    parts = ["# Bench", text(bench)]
    for name, png in plots.items():
        (out / f"{name}.png").write_bytes(png)
        parts.append(f"![{name}]({name}.png)")
    file = out / "report.md"
    file.write_text("\n\n".join(parts) + "\n")
    return file


def update(page: Path, bench: Bench) -> None:
    """Rewrite the place between ``<!-- bench -->`` and ``<!-- /bench -->`` of a page.

    Raises:
        ValueError: the page has no such place.
    """
    written, places = _PLACE.subn(
        lambda place: f"{place[1]}{text(bench)}\n\n{place[2]}", page.read_text()
    )
    if not places:
        raise ValueError(f"{page} has no place for it: write <!-- bench --> and <!-- /bench -->")
    page.write_text(written)


def text(bench: Bench) -> str:
    """All tables of what was measured, each with its heading."""
    sections = [origin(bench), "### Promises", table(
        ["what", "measured", "bound", "kept"], promises.rows(bench)
    )]  # fmt: skip
    for name, write_section in (
        ("core", _core),
        ("stages", _stages),
        ("scaling", _scaling),
        ("node", _node),
        ("start", _start),
    ):
        if name in bench:
            sections += write_section(bench[name])
    return "\n\n".join(sections)


def origin(bench: Bench) -> str:
    """When, where and beside what it was measured."""
    m = bench["machine"]
    return (
        f"{bench['date']}; {m['cpu']}; {m['system']}; Python {m['python']}, NumPy {m['numpy']}, "
        f"OpenCV {m['opencv']}. One thread each. Load average of the machine: "
        f"{bench['load']['before']:.1f} before, {bench['load']['after']:.1f} after (this run "
        "alone makes about 1): what is over that is other work, which lengthens the upper "
        "percentiles most."
    )


def table(head: Iterable[str], body: Iterable[Iterable[Any]]) -> str:
    """A Markdown table."""
    lines = [list(head), *([str(cell) for cell in row] for row in body)]
    written = [f"| {' | '.join(line)} |" for line in lines]
    return "\n".join([written[0], "|" + "---|" * len(lines[0]), *written[1:]])


def _core(core: Bench) -> list[str]:
    rows = [
        [
            name,
            *_percentiles(figures),
            f"{1e3 / figures['p50_ms']:.0f}",
            f"{figures['het_is_faster_by']:.2f}",
            f"{figures['paper_is_faster_by']:.2f}",
        ]
        for name, figures in core["trackers"].items()
    ]
    floor = core["floor"]
    absent = ", ".join(core["absent_peers"])
    return [
        "### Core",
        table(
            ["tracker", "p50 ms", "p95 ms", "p99 ms", "frames/s", "het's speed over it",
             "het-paper's speed over it"],
            rows,
        ),
        f"First {core['frames']} updates on each of {len(core['sequences'])} sequences, "
        "trackers taking turns; percentiles of all updates, speeds as medians over the sequences "
        "of the ratios of median times. On a sequence alone het's p99 is "
        f"{core['p99_over_p50_by_sequence']:.2f} times its p50 (median of the sequences)."
        + (f" Not in this OpenCV: {absent}." if absent else ""),
        _network(core),
        f"Floor: window {floor['window_ms']:.3f} ms, integral images "
        f"{floor['integrals_ms']:.3f} ms, product of votes and features "
        f"{floor['product_ms']:.3f} ms; a frame, timed in turns with them, takes "
        f"{floor['frame_ms']:.2f} ms, {core['ratio_to_floor']:.1f} times that. "
        f"The product that learning by ridge regression needs takes "
        f"{floor['learning_product_ms']:.3f} ms more; a frame takes "
        f"{core['ratio_to_floor_with_learning']:.1f} times the floor with it. A frame asks for "
        f"{core['frame_allocations_mb']:.1f} MB of memory at most at a time.",
    ]  # fmt: skip


def _network(core: Bench) -> str:
    if not (figures := core.get("network")):
        return "het-network is left out: name the networks' folder, `make bench MODELS=folder`."
    return (
        f"With a network it is {figures['speed_over_csrt']:.2f} times as fast as CSRT. With the "
        f"network in a second thread ({core['processors']} processors may be used) a frame takes "
        f"{figures['time_over_slower']:.2f} times as long as the slower of het and nanotrack-v3."
    )


def _stages(stages: Bench) -> list[str]:
    names = [*STAGES, "rest"]
    whole = {config: sum(times.values()) for config, times in stages.items()}
    rows = [
        [name, *(f"{t[name]:.2f} ({100 * t[name] / whole[c]:.0f} %)" for c, t in stages.items())]
        for name in names
    ]
    rows.append(["all", *(f"{whole[config]:.2f}" for config in stages)])
    head = ["stage", *(f"{config}, ms" for config in stages)]
    return ["### Where a frame's time goes", table(head, rows)]


def _scaling(scaling: Bench) -> list[str]:
    rows = [
        [
            words,
            ", ".join(f"{p['name']}: {p['p50_ms']:.2f}" for p in scaling[curve]["cases"]),
            f"{scaling[curve]['exponent']:+.2f}",
        ]
        for curve, words in _CURVES.items()
    ]
    return [
        "### How the cost grows",
        table(["over", "p50 of a frame, ms", "exponent"], rows),
        "The exponent k is that of time = c size^k, the size of targets and images being their "
        "side sqrt(w h): 0 is flat, 2 would be the area.",
    ]


def _node(node: Bench) -> list[str]:
    rows = []
    for name, case in node.items():
        for how, figures in (("two", case), ("one", case["one_process"])):
            rows.append([
                name, how, figures["sent"], figures["dropped"], f"{figures['rate']:.1f}",
                _joined(figures["latency"]), _joined(figures["own"]), _joined(case["core"]),
                f"{100 * figures['cpu_share']:.0f} %", f"{figures['rss_mb']:.0f}",
            ])  # fmt: skip
    return [
        "### Node",
        table(
            ["images", "processes", "sent", "dropped", "frames/s sent", "image to box, ms",
             "of it the node, ms", "core alone, ms", "CPU", "memory, MB"],
            rows,
        ),
        "Times are p50 / p95 / p99. bgr8 images, best effort, the shipped Fast DDS profile; a "
        "target of 60x150 px. Image to box is from publishing the image to having the box, in "
        "the camera's process; the node is from an image's arrival in its callback to its "
        "status; the core alone has the same frames at the same rate. CPU and memory are the "
        "tracker's process; with one process the camera and its ready-made images as well.",
    ]  # fmt: skip


def _start(start: Bench) -> list[str]:
    return [
        "### Start",
        f"{start['seconds']:.2f} s from starting the installed `tracker` until a waiting camera "
        f"is connected, with {start['rss_mb']:.0f} MB. What imports add, one after the other:",
        table(
            ["import", "s", "MB"],
            [
                [f"`{name}`", f"{figures['seconds']:.2f}", f"{figures['rss_mb']:.0f}"]
                for name, figures in start["imports"].items()
            ],
        ),
    ]


def _percentiles(figures: Bench) -> list[str]:
    return [f"{figures[f'p{percent}_ms']:.2f}" for percent in (50, 95, 99)]


def _joined(figures: Bench) -> str:
    return " / ".join(f"{figures[f'p{percent}_ms']:.1f}" for percent in (50, 95, 99))
