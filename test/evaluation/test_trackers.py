# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from het_ros import Box, TrackerConfig
from het_ros.evaluation import opencv_peers
from het_ros.evaluation.protocols import follow
from het_ros.evaluation.trackers import DEFAULT, parsed, split_names, tracker_spec
from het_ros.tracking.paper.config import PaperConfig
from het_ros.tracking.parameter import Parameter


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("het", ["het"]),
        ("het, csrt ,", ["het", "csrt"]),
        ("het:sub_patches=5,seed=3,csrt", ["het:sub_patches=5,seed=3", "csrt"]),
        ("a@het:seed=1,b@het:seed=2", ["a@het:seed=1", "b@het:seed=2"]),
    ],
)
def test_names_are_split_outside_configurations(text, names):
    assert split_names(text) == names


@pytest.mark.parametrize(
    ("default", "text", "value"),
    [
        (1, "5", 5),
        (1.0, "5", 5.0),
        (1.0, "1e-3", 1e-3),
        (True, "false", False),
        ("a", "b", "b"),
        (("a",), "a+b", ("a", "b")),
        (("a",), ["a", "b"], ("a", "b")),  # from a file
        (1.0, 5, 5.0),  # from a file
    ],
)
def test_values_take_the_type_of_their_default(default, text, value):
    found = parsed(Parameter("p", default, ""), text)
    assert (found, type(found)) == (value, type(value))


ONE_THREAD = TrackerConfig(network_thread=False)


def config_of(name):
    return tracker_spec(name).build.args[0]


def test_het_is_the_default_configuration_and_het_paper_the_papers():
    assert config_of("het") == ONE_THREAD
    assert config_of("het-paper") == PaperConfig()
    assert config_of("het:sub_patches=5,seed=3") == replace(ONE_THREAD, sub_patches=5, seed=3)
    assert config_of("het:network_thread=true") == TrackerConfig()
    assert config_of("het-paper:sub_patches=7") == PaperConfig(sub_patches=7)


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("a.yaml", "sub_patches: 5\nseed: 3\n"),
        ("a.yaml", "/tracker:\n  ros__parameters:\n    sub_patches: 5\n    seed: 3\n"),
        ("a.json", json.dumps({"sub_patches": 5, "seed": 3})),
    ],
)
def test_a_configuration_may_be_a_file(tmp_path, file, text):
    pytest.importorskip("yaml")
    (tmp_path / file).write_text(text)
    spec = tracker_spec(f"mine@het:{tmp_path / file}")
    assert spec.name == "mine"
    assert spec.build.args[0] == replace(ONE_THREAD, sub_patches=5, seed=3)


@pytest.mark.parametrize(
    ("name", "complaint"),
    [
        ("nobody", "no tracker is called 'nobody'; there are het, het-paper, csrt"),
        ("het:colour=1", "TrackerConfig has no colour; it has .*sub_patches"),
        ("het-paper:ridge=1", "PaperConfig has no ridge; it has .*sub_patches"),
        ("het:sub_patches=0", "sub_patches lies in"),
        ("het:sub_patches=many", "sub_patches takes a int, not 'many'"),
        ("het:none.yaml", "there is no configuration file none.yaml"),
    ],
)
def test_a_wrong_name_says_what_would_be_right(name, complaint):
    if name.endswith("yaml"):
        pytest.importorskip("yaml")
    with pytest.raises(ValueError, match=complaint):
        tracker_spec(name)


def test_the_fingerprint_changes_with_the_configuration_only():
    assert tracker_spec("het").fingerprint == tracker_spec("again@het").fingerprint
    assert tracker_spec("het").fingerprint != tracker_spec("het:sub_patches=5").fingerprint
    assert tracker_spec("het").source == tracker_spec("het-paper").source != ""


def test_a_spec_travels_and_gives_the_same_boxes_for_the_same_seed(moving):
    spec = pickle.loads(pickle.dumps(tracker_spec("het")))
    box = Box(*moving.truth[0])
    first, second = (follow(spec.build(4), moving.frames, box) for _ in range(2))
    np.testing.assert_array_equal(first.boxes, second.boxes)
    assert set(first.states[1:]) <= {"TRACKING", "COASTING", "LOST"}
    assert np.isfinite(first.scores[1:]).all()
    assert np.isfinite(first.covariances[1:]).all()


def test_folder_names_are_safe():
    assert tracker_spec("het:sub_patches=5,seed=3").folder == "het_sub_patches=5_seed=3"
    assert tracker_spec("a/b c@het").folder == "a_b_c"


PEERS = [name for name in DEFAULT if not name.startswith("het")]


@pytest.mark.parametrize("name", PEERS)
def test_every_peer_follows_a_moving_square_or_says_what_to_install(name, moving):
    if name not in opencv_peers.available():
        with pytest.raises(ValueError, match="install opencv-contrib-python-headless"):
            tracker_spec(name)
        pytest.skip(f"{name} needs opencv-contrib; that it says so was tested")
    track = follow(tracker_spec(name).build(0), moving.frames, Box(*moving.truth[0]))
    assert track.error == ""
    assert np.isfinite(track.boxes).all()
    assert set(track.states[1:]) <= {"TRACKING", "LOST"}


@pytest.mark.parametrize("name", PEERS)
def test_a_peer_that_is_given_a_box_outside_the_image_fails_on_record(name, moving):
    if name not in opencv_peers.available():
        pytest.skip(f"{name} needs opencv-contrib")
    track = follow(tracker_spec(name).build(0), moving.frames, Box(-300, -300, 10, 12))
    assert len(track.boxes) == len(moving.frames)
    assert np.isfinite(track.boxes).all()
