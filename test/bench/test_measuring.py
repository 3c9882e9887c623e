# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""What is measured, on tiny inputs: that it is measured, never how long it took."""

import os
from dataclasses import replace

import numpy as np
import pytest

from het_ros.bench import core as bench_core
from het_ros.bench.allocations import peak_of_a_frame
from het_ros.bench.core import core, sequences_for
from het_ros.bench.floor import floor, sizes_of
from het_ros.bench.footage import STEP, Footage, middle
from het_ros.bench.imports import weigh_imports
from het_ros.bench.process import usage
from het_ros.bench.scaling import Case, scaling
from het_ros.bench.stages import STAGES, stage_times, timed_stages
from het_ros.tracking.bottom.sub_patches import draw_layout
from het_ros.tracking.box import Box
from het_ros.tracking.config import TrackerConfig
from het_ros.tracking.features import extractor
from het_ros.tracking.features.extractor import FeatureExtractor, target_cells
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.top.kalman import AdaptiveKalman
from het_ros.tracking.tracker import HierarchicalEnsembleTracker

SMALL = replace(TrackerConfig(), features=20, sub_patches=3)


@pytest.fixture(scope="module")
def footage():
    return Footage(160, 120, 3)


def test_footage_moves_forth_and_back(footage):
    np.testing.assert_array_equal(footage[1][:, :-STEP], footage[0][:, STEP:])
    np.testing.assert_array_equal(footage[3], footage[1])
    assert footage[0].shape == (120, 160, 3)
    assert footage[0].std() > 10


def test_footage_of_one_frame_stands_still():
    still = Footage(32, 24, 1)
    np.testing.assert_array_equal(still[0], still[7])


def test_the_tracker_follows_the_footage(footage):
    """Else a bench on it would time a tracker that has lost its target."""
    tracker = HierarchicalEnsembleTracker(TrackerConfig())
    box = middle(footage, (24, 40))
    tracker.init(footage[0], box)
    for i in range(1, 12):
        estimate = tracker.update(footage[i], 1 / 30)
        shifted = Box(box.x - STEP * footage.at(i), *box.as_tuple()[1:])
        assert estimate.box.iou(shifted) > 0.7


def test_sizes_of_the_floor_are_those_of_the_tracker(footage):
    config, image = TrackerConfig(), footage[0]
    cells = target_cells((40.0, 40.0), config.working_side)
    rng = np.random.default_rng(0)
    patch = draw_layout(cells, config.sub_patches, config.sub_patch_fraction, rng).size
    extractor = FeatureExtractor(
        image, cells, patch, config.features, config.search_radius, config.gray_below, rng
    )
    frame = extractor.look(image, np.array([80.0, 60.0]), np.array([40.0, 40.0]))
    sizes = sizes_of(config)
    assert frame.window.pixels.shape[:2] == sizes.window
    assert frame.channels[0].shape == sizes.cells
    assert len(frame.channels) == sizes.channels
    assert frame.features.shape == (config.features, *frame.features.shape[1:])
    assert frame.features[0].size == sizes.places


def test_floor_is_the_sum_of_its_passes():
    frames = []
    found = floor(sizes_of(SMALL), lambda: frames.append(0), repetitions=3)
    assert len(frames) == 3
    parts = [found[f"{name}_ms"] for name in ("window", "integrals", "product")]
    assert found["total_ms"] == pytest.approx(sum(parts))
    assert min(parts) > 0


@pytest.mark.parametrize(
    ("config", "idle"),
    [
        (SMALL, {"network"}),
        (
            PaperConfig(features=20, sub_patches=3),
            {
                *("ego-motion", "re-detection", "colour", "flow"),
                *("network", "background", "confidence", "size"),
            },
        ),
    ],
)
def test_every_stage_that_a_configuration_has_takes_time(config, idle, footage):
    found = stage_times(config, footage, middle(footage, (24, 40)), frames=2, warm_up=1)
    assert {stage for stage in STAGES if found[stage] == 0} == idle
    assert list(found) == [*STAGES, "rest"]
    assert found["rest"] >= 0  # no stage is counted twice


def test_timed_stages_leaves_everything_as_it_was():
    before = extractor.cut_window, AdaptiveKalman.predict
    with pytest.raises(KeyError), timed_stages():
        raise KeyError
    assert (extractor.cut_window, AdaptiveKalman.predict) == before


def test_scaling_times_every_case(footage):
    def curve(*sizes):
        return [Case(f"{s}", s, SMALL, footage, (s, s)) for s in sizes]

    found = scaling({"target": curve(16, 32), "image": curve(20, 30)}, frames=3, quiet=True)
    assert [case["name"] for case in found["target"]["cases"]] == ["16", "32"]
    assert all(case["tracking"] == 1 for case in found["target"]["cases"])
    times = [case["p50_ms"] for case in found["target"]["cases"]]
    assert found["target_factor"] == pytest.approx(max(times) / min(times))


def test_core_without_a_folder_is_measured_on_rendered_frames(tmp_path):
    frames = 4
    sequences = sequences_for(None, tmp_path, frames)
    assert len(sequences[0].frames) == frames + 1
    found = core(sequences, frames, quiet=True)
    assert found["p50_ms"] > 0
    assert found["p99_over_p50"] >= 1
    assert found["trackers"]["het"]["het_is_faster_by"] == 1
    assert set(found["absent_peers"]).isdisjoint(found["trackers"])


def test_core_with_a_folder_of_networks_times_them_on_one_thread_and_on_two(
    tmp_path, made_network, monkeypatch
):
    monkeypatch.setattr(bench_core, "COMPARED", ("csrt",))
    frames = 4
    sequences = sequences_for(None, tmp_path, frames)
    found = core(sequences, frames, quiet=True, models=made_network.parent)
    rows = found["trackers"]
    assert {"het-network", "het-network on two threads", "nanotrack-v3"} <= set(rows)
    assert all(figures["p50_ms"] > 0 for figures in rows.values())
    assert found["network"]["time_over_slower"] > 0
    assert found["processors"] >= 1


def test_a_folder_without_networks_is_refused(tmp_path):
    with pytest.raises(ValueError, match="has no network for nanotrack-v3"):
        core([], 1, quiet=True, models=tmp_path)


def test_usage_of_this_process():
    before = usage(os.getpid())
    np.linalg.svd(np.random.default_rng(0).random((300, 300)))
    after = usage(os.getpid())
    assert after.cpu >= before.cpu > 0
    assert 0 < after.rss_mb <= after.peak_mb
    assert after.threads >= 1


def test_a_frame_asks_for_no_large_arrays(footage):
    """What it asks for would be over twice its feature maps with one more copy of them."""
    config = TrackerConfig()
    maps = 4 * config.features * sizes_of(config).places / 1e6
    assert peak_of_a_frame(config, footage, middle(footage, (40, 40))) < 2 * maps


def test_imports_are_weighed_one_after_the_other():
    found = weigh_imports(("json", "numpy"))
    assert list(found) == ["json", "numpy"]
    assert all(figures["seconds"] > 0 for figures in found.values())
    assert found["numpy"]["rss_mb"] > found["json"]["rss_mb"] >= 0


def test_more_features_ask_for_more_memory(footage):
    box = middle(footage, (24, 40))
    few, many = (
        peak_of_a_frame(replace(SMALL, features=m), footage, box, frames=1) for m in (20, 200)
    )
    assert 0 < few < many
