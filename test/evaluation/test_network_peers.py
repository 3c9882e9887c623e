# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import pickle
import shutil

import cv2
import numpy as np
import pytest

from het_ros import Box, TrackerConfig
from het_ros.evaluation import network_peers, opencv_peers
from het_ros.evaluation.choice import chosen
from het_ros.evaluation.nanotrack import likeness
from het_ros.evaluation.network_peers import NAMES
from het_ros.evaluation.protocols import follow
from het_ros.evaluation.readers import read_sequences
from het_ros.evaluation.trackers import tracker_spec


def test_files_are_recognised(models):
    assert tuple(network_peers.found(models)) == NAMES


def test_names_of_folders_do_not_matter(models, tmp_path):
    shutil.copytree(models / "nanotrackv3", tmp_path / "any" / "name")
    assert list(network_peers.found(tmp_path)) == ["nanotrack-v3"]


def test_ours_with_a_network_is_left_out_where_its_files_are_not(tmp_path):
    assert "het-network" not in [spec.name for spec in chosen("", tmp_path).trackers]


def test_ours_with_a_network_is_the_default_with_nanotrack_v3(models):
    spec = tracker_spec("het-network:seed=3", models)
    folder = network_peers.files_of("nanotrack-v3", models)[0].parent
    assert spec.build.args[0] == TrackerConfig(network=str(folder), network_thread=False, seed=3)


@pytest.mark.parametrize("name", (*NAMES, "het-network"))
def test_without_files_one_line_says_where_they_are(name, tmp_path):
    for folder in (None, tmp_path, tmp_path / "none"):
        with pytest.raises(ValueError, match=r"github.com/HonglinChu.*github.com/opencv"):
            tracker_spec(name, folder)


def test_the_report_says_which_networks_are_left_out_and_why(tmp_path):
    (note,) = (n for n in chosen("").notes if "nanotrack" in n)
    assert all(name in note for name in NAMES)
    assert "MODELS" in note
    (note,) = (n for n in chosen("", tmp_path).notes if "nanotrack" in n)
    assert str(tmp_path) in note
    assert chosen("het").notes == [], "who names trackers knows what is left out"


def test_with_a_folder_they_are_compared(models):
    names = [spec.name for spec in chosen("", models).trackers]
    assert names[-5:] == ["het-network", *NAMES]
    assert not any("nanotrack" in note for note in chosen("", models).notes)


@pytest.mark.parametrize("name", (*NAMES, "het-network"))
def test_each_follows_real_frames_and_says_how_sure_it_is(name, models, data):
    if name != "nanotrack-v3" and not hasattr(cv2, "TrackerVit_create"):
        pytest.skip("this OpenCV is too old")
    (sequence,) = read_sequences(data, ("Crossing",))
    spec = pickle.loads(pickle.dumps(tracker_spec(name, models)))
    frames = sequence.frames.taken(slice(0, 12))
    tracks = [follow(spec.build(0), frames, Box(*sequence.truth[0])) for _ in range(2)]
    np.testing.assert_array_equal(tracks[0].boxes, tracks[1].boxes)
    track = tracks[0]
    assert track.error == ""
    assert np.isfinite(track.boxes).all()
    assert ((track.scores[1:] >= 0) & (track.scores[1:] <= 1)).all()
    if name != "vit":  # whose normalisation is wrong
        assert np.linalg.norm(track.boxes[-1][:2] - sequence.truth[11][:2]) < 15


def test_the_fingerprint_is_of_the_files(models, tmp_path):
    shutil.copytree(models, tmp_path / "m")
    same = tracker_spec("nanotrack-v3", tmp_path / "m").fingerprint
    assert same == tracker_spec("nanotrack-v3", models).fingerprint
    others = {tracker_spec(name, models).fingerprint for name in NAMES}
    assert len(others) == len(NAMES)


def test_the_corrected_deviation_is_the_one_whose_inverse_quaternion_divides():
    a, b, c, d = network_peers.corrected_deviation()
    length = a * a + b * b + c * c + d * d
    inverse = np.array([a, -b, -c, -d]) / length  # what OpenCV multiplies with
    np.testing.assert_allclose(inverse[:3], 1 / np.array(network_peers.DEVIATION))


def test_a_change_of_size_or_aspect_makes_a_box_less_likely():
    sizes = np.array([[10, 20, 20, 5], [10, 20, 10, 5]], np.float32).reshape(2, 1, 4)
    same, larger, wider, smaller = likeness(sizes, (10, 10), 0.1)[0]
    assert same == pytest.approx(1)
    assert larger == pytest.approx(smaller) == pytest.approx(np.exp(-0.1))
    extent = np.sqrt(35 * 25) / 20
    assert wider == pytest.approx(np.exp(-0.1 * (2 * extent - 1)))


class Unsure:
    """An OpenCV tracker that finds nothing."""

    def init(self, image, box):
        assert all(isinstance(value, int) for value in box)

    def update(self, image):
        return False, (0, 0, 0, 0)

    def getTrackingScore(self):  # noqa: N802
        return 0.125


def test_what_is_not_found_is_lost_with_its_score():
    tracker = opencv_peers.ScoringTracker(Unsure)
    tracker.init(np.zeros((20, 20, 3), np.uint8), Box(1.5, 2.5, 5, 6))
    answer = tracker.update(np.zeros((20, 20, 3), np.uint8), 0.1)
    assert (answer.box, answer.state, answer.score) == (None, "LOST", 0.125)
